// Least squares of torque or force, on motions and torques in closed form, without a simulator.
#include "host/effort/effort_screen.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "host/diagnose/effort_diagnosis.hpp"
#include "sim/harmonic.hpp"
#include "tests/host/effort/made_effort.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

double five_orders(const Point& point) {
  const double amplitudes[][2] = {{6, 0.012}, {18, 0.008}, {24, 0.006}, {36, 0.010}, {72, 0.016}};
  double sum = 0.0;
  for (const auto& [order, amplitude] : amplitudes) sum += amplitude * std::cos(order * point.x + order);
  return sum;
}

std::optional<host::Diagnosis> by_effort_of(const std::vector<const host::Record*>& train,
                                            const std::vector<const host::Record*>& validate,
                                            std::shared_ptr<const host::EffortScreen>& seen) {
  const sim::DriveDescription model = motor();
  const host::PreparedSets sets = host::split_sets(model, train, validate);
  const std::shared_ptr<const host::EffortScreen> screen = host::screen_of(model, sets);
  if (!screen->empty()) seen = screen;
  if (screen->chosen.empty() && !host::effort_decides(*screen, sets.validation)) return {};
  return host::diagnosis_of(model, sets, screen);
}

// Catches a search that stops at one order, counts orders over a wrong period, or has the wrong sign.
TEST(EffortScreen, FindsFiveOrdersOfCoggingInASlowRecord) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::Record train = record_of(slow_turning, five_orders, 0.0, 20.0, 1);
  const host::Record validate = record_of(slow_turning, five_orders, 23.0, 36.0, 2);
  std::shared_ptr<const host::EffortScreen> seen;
  const auto by_effort = by_effort_of({&train}, {&validate}, seen);
  ASSERT_TRUE(by_effort.has_value());
  const host::Diagnosis& diagnosis = *by_effort;
  EXPECT_EQ(diagnosis.verdict.status, host::Status::missing);
  ASSERT_THAT(diagnosis.verdict.effects, ElementsAre("cogging"));
  const sim::EffectEntry& cogging = *diagnosis.best.find("cogging");
  EXPECT_NEAR(cogging.at("period"), kTurn, 1e-3);
  std::vector<double> orders;
  for (const sim::HarmonicTerm& term : sim::harmonics_of(cogging)) orders.push_back(term.order);
  EXPECT_THAT(orders, ElementsAre(6, 18, 24, 36, 72));
  EXPECT_NEAR(std::hypot(cogging.at("cosine_6"), cogging.at("sine_6")), 0.012, 0.0005);
  EXPECT_NEAR(cogging.at("cosine_18"), -0.008 * std::cos(18.0), 0.0006) << "load helps where the motor must give less";
  ASSERT_NE(diagnosis.screen, nullptr);
  EXPECT_LT(std::pow(diagnosis.screen->best().validate, 2), 0.05) << "95 % of the variance";
  EXPECT_NEAR(diagnosis.base.find("coulomb")->at("level"), kCoulomb, 0.1 * kCoulomb);
}

/// Swings of 40 degrees about the vertical, as of a pendulum.
Point swinging(double t_s) {
  const double slow = kTurn * 0.15, wave = kTurn * 0.4;
  return {0.6 * std::sin(slow * t_s) + 0.25 * std::sin(wave * t_s),
          0.6 * slow * std::cos(slow * t_s) + 0.25 * wave * std::cos(wave * t_s),
          -0.6 * slow * slow * std::sin(slow * t_s) - 0.25 * wave * wave * std::sin(wave * t_s)};
}

// Less than a turn must suffice to tell a weight from a spring and from friction under load.
TEST(EffortScreen, SeesAWeightInPartOfATurn) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const auto weight = [](const Point& point) { return 0.08 * std::sin(point.x + 0.3); };
  const host::Record train = record_of(swinging, weight, 0.0, 20.0, 6);
  const host::Record validate = record_of(swinging, weight, 23.0, 36.0, 7);
  std::shared_ptr<const host::EffortScreen> seen;
  const auto by_effort = by_effort_of({&train}, {&validate}, seen);
  ASSERT_TRUE(by_effort.has_value());
  EXPECT_THAT(by_effort->verdict.effects, ElementsAre("cogging"));
  EXPECT_NEAR(by_effort->best.find("cogging")->at("period"), kTurn, 1e-9);
  const sim::EffectEntry& cogging = *by_effort->best.find("cogging");
  EXPECT_NEAR(std::hypot(cogging.at("cosine"), cogging.at("sine")), 0.08, 0.002);
}

// An effect that the model already has in a nonlinear form must not be searched for again.
TEST(EffortScreen, TakesWhatTheModelHasAsItStands) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const auto dragging = [](const Point& point) {
    return std::copysign(0.02, point.w) * std::exp(-std::abs(point.w) / 2.0);
  };
  const host::Record train = record_of(slow_turning, dragging, 0.0, 20.0, 8);
  const host::Record validate = record_of(slow_turning, dragging, 23.0, 36.0, 9);
  sim::DriveDescription model = motor();
  const auto left = [&] {
    return host::screen_effort(model, host::compare_on({&train}, model), host::compare_on({&validate}, model), 6)
        .base.validate;
  };
  const double without = left();
  model.find("coulomb")->parameters["level"] = kCoulomb;
  model.effects.push_back({"stribeck", {{"static", 2.0 * kCoulomb}, {"omega1", 2.0}, {"omega2", 2.0}}, {}, {}});
  EXPECT_LT(left(), 0.5 * without);
}

// If a machine has warmed up between the records, no effect is missing, and the verdict reports the change.
TEST(EffortScreen, TellsFrictionThatDiffersBetweenTheRecords) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const auto cold = [](const Point&) { return 0.0; };
  const auto warm = [](const Point& point) { return -std::copysign(0.3 * kCoulomb, point.w); };
  const host::Record train = record_of(slow_turning, cold, 0.0, 12.0, 12);
  const host::Record validate = record_of(slow_turning, warm, 13.0, 21.0, 13);
  std::shared_ptr<const host::EffortScreen> seen;
  auto by_effort = by_effort_of({&train}, {&validate}, seen);
  ASSERT_TRUE(by_effort.has_value());
  host::name_coordinate(*by_effort);
  EXPECT_EQ(by_effort->verdict.status, host::Status::unexplained);
  EXPECT_EQ(by_effort->verdict.where, "between the records");
  ASSERT_TRUE(seen->judge_alone.has_value());
  EXPECT_NEAR(seen->judge_alone->model.find("coulomb")->at("level"), 0.7 * kCoulomb, 0.05 * kCoulomb);
}

// With a free inertia, steady speeds would fit anything.
TEST(EffortScreen, HoldsTheInertiaThatSteadySpeedsDoNotShow) {
  const auto at = [](double w) { return [w](double t_s) { return Point{w * t_s, w, 0.0}; }; };
  const auto offset = [](const Point&) { return 0.006; };
  std::vector<host::Record> records;
  for (const double w : {3.0, 6.0, 9.0, 12.0})
    for (const double sign : {1.0, -1.0}) records.push_back(record_of(at(sign * w), offset, 0.0, 3.0, 5));
  std::vector<const host::Record*> train, validate;
  for (std::size_t k = 0; k < records.size(); ++k) (k % 4 < 2 ? train : validate).push_back(&records[k]);
  std::shared_ptr<const host::EffortScreen> seen;
  const auto by_effort = by_effort_of(train, validate, seen);
  ASSERT_TRUE(by_effort.has_value());
  const host::Diagnosis& diagnosis = *by_effort;
  EXPECT_EQ(diagnosis.verdict.status, host::Status::ambiguous);
  EXPECT_THAT(diagnosis.verdict.effects, UnorderedElementsAre("constant_torque", "dac_offset", "coulomb_asymmetry"));
  EXPECT_EQ(diagnosis.best.find("inertia")->at("J"), 1.1 * kInertia);
  EXPECT_NEAR(diagnosis.best.find("constant_torque")->at("torque"), -0.006, 0.0005);
}

/// A drive in a position loop. Its amplifier is limited to a sixth of the largest command. Integrated in Euler steps of
/// 0.1 ms.
template <typename Aim>
host::Record limited_record(Aim aim, double duration_s) {
  constexpr double kStep_s = 1e-4, kMost = 1.5, kHeavy = 0.004, kOil = 0.01, kDry = 0.4;
  host::Record record;
  record.path = "limited.csv";
  record.sample_period_s = 0.001;
  double x = 0.0, w = 0.0;
  for (int k = 0; k < static_cast<int>(duration_s / record.sample_period_s); ++k) {
    const double t_s = k * record.sample_period_s;
    const auto [place, speed] = aim(t_s);
    const double asked = std::clamp(30.0 * (place - x) + 0.8 * (speed - w), -6.0 * kMost, 6.0 * kMost);
    record.t_s.push_back(t_s);
    record.x.push_back(5e-4 * std::round(x / 5e-4));
    record.i_A.push_back(asked / kPerAmpere);
    for (int step = 0; step < 10; ++step) {
      const double drives = std::clamp(asked, -kMost, kMost) - kOil * w;
      const double resists = w != 0.0 ? std::copysign(kDry, w) : std::clamp(drives, -kDry, kDry);
      const double next = w + kStep_s * (drives - resists) / kHeavy;
      w = w * next < 0.0 ? 0.0 : next;
      x += kStep_s * w;
    }
  }
  return record;
}

/// Swings that become faster, with the maximum speed of the first one.
std::pair<double, double> swings(double t_s) {
  const double turn = kTurn * (0.5 + 0.28 * t_s) * t_s, faster = 1.0 + 1.125 * t_s;
  return {4.0 / faster * std::sin(turn), kTurn * 2.0 * std::cos(turn)};
}

/// Moves from place to place in 0.35 s, with rests between.
std::pair<double, double> moves(const std::array<double, 6>& places, double t_s) {
  constexpr double kMove_s = 0.35, kEvery_s = 0.65;
  const auto n = static_cast<std::size_t>(t_s / kEvery_s);
  if (n + 1 >= places.size()) return {places.back(), 0.0};
  const double s = std::min(1.0, (t_s - kEvery_s * static_cast<double>(n)) / kMove_s), way = places[n + 1] - places[n];
  return {places[n] + way * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s),
          way * s * s * (30.0 - 60.0 * s + 30.0 * s * s) / kMove_s};
}

// Commands above a current limit have no effect. The regression has no term for this. A second mass or a ripple must
// not be named instead, because the motion shows the limit.
TEST(EffortScreen, LeavesALimitOfTheCurrentToTheMotion) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  sim::DriveDescription model = motor();
  model.find("inertia")->parameters["J"] = 0.004;
  model.find("viscous")->parameters["B"] = 0.01;
  model.find("coulomb")->parameters["level"] = 0.4;
  model.data.encoder_resolution = 5e-4;
  const auto to = [](std::array<double, 6> places) {
    return limited_record([places](double t_s) { return moves(places, t_s); }, 3.5);
  };
  const host::Record sweep = limited_record(swings, 8.0), there = to({0.0, 14.0, -6.0, 8.0, 0.0, 15.0});
  const host::Record validate = to({0.0, -9.0, 7.0, 16.0, 0.0, -5.0});
  const host::EffortScreen screen =
      host::screen_effort(model, host::compare_on({&sweep, &there}, model), host::compare_on({&validate}, model), 6);
  ASSERT_FALSE(screen.empty());
  EXPECT_GT(screen.base.validate, 0.1);
  EXPECT_TRUE(screen.chosen.empty()) << screen.chosen.front().kinds.front();
}

// Friction of a screw with varying preload: less than one and a half periods over the travel, so it never repeats. With
// a period that is a few per cent wrong, a quarter of it remains.
TEST(EffortScreen, ClaimsFrictionThatVariesOverLessThanTwoWaves) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  constexpr double kLength = 30.0;
  const auto wide = [](double t_s) {
    const double slow = kTurn * 0.043, wave = kTurn * 0.31;
    return Point{-18.0 * std::cos(slow * t_s) - 1.0 / wave * std::cos(wave * t_s),
                 18.0 * slow * std::sin(slow * t_s) + std::sin(wave * t_s),
                 18.0 * slow * slow * std::cos(slow * t_s) + wave * std::cos(wave * t_s)};
  };
  const auto preload = [](const Point& at) {
    return std::copysign(0.4 * kCoulomb, at.w) * std::sin(kTurn * at.x / kLength + 1.0);
  };
  const host::Record train = record_of(wide, preload, 0.0, 40.0, 11);
  const host::Record validate = record_of(wide, preload, 51.0, 80.0, 12);
  const host::EffortScreen screen =
      host::screen_effort(motor(), host::compare_on({&train}, motor()), host::compare_on({&validate}, motor()), 6);
  ASSERT_EQ(screen.chosen.size(), 1U);
  EXPECT_THAT(screen.chosen.front().kinds, ElementsAre("position_dependent_friction"));
  EXPECT_THAT(screen.tied.front(), IsEmpty()) << "so long a wave is no ripple of a motor";
  EXPECT_NEAR(screen.best().model.find("position_dependent_friction")->at("period"), kLength, 0.02 * kLength);
  EXPECT_LT(screen.best().validate, 0.35 * screen.base.validate);
}

/// Swings A (1 - cos(2 pi f t)) of several frequencies from rest, and the load on a damped spring that they excite, in
/// steps of 0.1 ms.
class Shaken {
 public:
  static constexpr double kAntiresonance_Hz = 3.66, kDamping = 0.05, kLoad = 0.6 * kInertia;

  explicit Shaken(std::vector<std::array<double, 2>> swings) : swings_(std::move(swings)) {}

  host::Record record(unsigned seed) {
    return record_of(
        [this](double t_s) {
          go_to(t_s);
          return motor_end(t_s);
        },
        [this](const Point&) { return kLoad * pull_; }, 0.0, 20.0, seed);
  }

 private:
  Point motor_end(double t_s) const {
    Point sum{0.0, 0.0, 0.0};
    for (const auto& [amplitude, hertz] : swings_) {
      const double omega = kTurn * hertz;
      sum.x += amplitude * (1.0 - std::cos(omega * t_s));
      sum.w += amplitude * omega * std::sin(omega * t_s);
      sum.a += amplitude * omega * omega * std::cos(omega * t_s);
    }
    return sum;
  }

  void go_to(double t_s) {
    constexpr double kStep_s = 1e-4, kOwn = kTurn * kAntiresonance_Hz;
    for (; now_s_ < t_s; now_s_ += kStep_s) {
      const Point motor = motor_end(now_s_ + 0.5 * kStep_s);
      pull_ = kOwn * kOwn * (motor.x - x_) + 2.0 * kDamping * kOwn * (motor.w - w_);
      w_ += kStep_s * pull_;
      x_ += kStep_s * w_;
    }
  }

  std::vector<std::array<double, 2>> swings_;  ///< amplitude, rad, and frequency, Hz
  double now_s_ = 0.0, x_ = 0.0, w_ = 0.0, pull_ = 0.0;
};

// The forms that are tried first are 12 % apart.
TEST(EffortScreen, FindsTheAntiresonanceBetweenTheFormsTriedFirst) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::Record train = Shaken({{4.0, 0.31}, {0.8, 0.83}, {0.6, 2.6}, {0.6, 4.9}, {0.3, 7.1}}).record(21);
  const host::Record validate = Shaken({{3.0, 0.37}, {0.9, 0.71}, {0.7, 2.1}, {0.5, 5.3}, {0.3, 8.3}}).record(22);
  const host::EffortScreen screen =
      host::screen_effort(motor(), host::compare_on({&train}, motor()), host::compare_on({&validate}, motor()), 1);
  ASSERT_EQ(screen.chosen.size(), 1U);
  ASSERT_THAT(screen.chosen.front().kinds, ElementsAre("compliance"));
  const sim::EffectEntry& found = *screen.best().model.find("compliance");
  const double share = found.at("load_fraction");
  EXPECT_NEAR(share, Shaken::kLoad / (kInertia + Shaken::kLoad), 0.02);
  EXPECT_NEAR(found.at("damping_ratio") * std::sqrt(1.0 - share), Shaken::kDamping, 0.01);
  EXPECT_NEAR(found.at("resonance") * std::sqrt(1.0 - share), Shaken::kAntiresonance_Hz,
              0.005 * Shaken::kAntiresonance_Hz);
}

// An unknown pitch with a dozen periods over the travel.
TEST(EffortScreen, FindsThePeriodToAThousandth) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  constexpr double kPitch = 2.3;
  const auto ripple = [](const Point& at) {
    return 0.012 * std::sin(kTurn * at.x / kPitch) + 0.006 * std::cos(2.0 * kTurn * at.x / kPitch);
  };
  const host::Record train = record_of(slow_turning, ripple, 0.0, 20.0, 13);
  const host::Record validate = record_of(slow_turning, ripple, 23.0, 36.0, 14);
  sim::DriveDescription slide = motor();
  const host::EffortScreen screen =
      host::screen_effort(slide, host::compare_on({&train}, slide), host::compare_on({&validate}, slide), 6);
  ASSERT_FALSE(screen.chosen.empty());
  EXPECT_THAT(screen.chosen.front().kinds, ElementsAre("cogging"));
  EXPECT_NEAR(screen.best().model.find("cogging")->at("period"), kPitch, 1e-3 * kPitch);
}

// The measured torque itself must not explain an effect in proportion to the torque.
TEST(EffortScreen, ClaimsNothingWhereNothingIsMissing) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const auto nothing = [](const Point&) { return 0.0; };
  const host::Record train = record_of(slow_turning, nothing, 0.0, 20.0, 3);
  const host::Record validate = record_of(slow_turning, nothing, 23.0, 36.0, 4);
  const host::EffortScreen screen =
      host::screen_effort(motor(), host::compare_on({&train}, motor()), host::compare_on({&validate}, motor()), 6);
  ASSERT_FALSE(screen.empty());
  EXPECT_TRUE(screen.chosen.empty());
  EXPECT_LT(screen.base.validate, 0.05);
  EXPECT_NEAR(screen.base.model.find("viscous")->at("B"), kViscous, 0.1 * kViscous);
  EXPECT_NEAR(screen.base.model.find("coulomb")->at("level"), kCoulomb, 0.05 * kCoulomb);
}

}  // namespace
