// Records in closed form (made_effort.hpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/compare/comparison.hpp"
#include "host/effort/effort_screen.hpp"
#include "tests/host/effort/made_effort.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

using testing::Contains;
using testing::IsEmpty;

template <typename Motion, typename Further>
host::EffortScreen screened(Motion motion, Further further) {
  const host::Record train = record_of(motion, further, 0.0, 20.0, 1);
  const host::Record validate = record_of(motion, further, 31.0, 45.0, 2);
  const sim::DriveDescription model = motor();
  host::EffortScreen screen =
      host::screen_effort(model, host::compare_on({&train}, model), host::compare_on({&validate}, model), 6);
  EXPECT_FALSE(screen.empty());
  return screen;
}

template <typename Further>
host::EffortScreen screened(Further further) {
  return screened(slow_turning, further);
}

std::vector<std::string> named(const host::EffortScreen& screen) { return screen.best().kinds; }

}  // namespace

TEST(CertainEffects, ClaimsNothingWhereNothingIsMissing) {
  const host::EffortScreen found = screened([](const Point&) { return 0.0; });
  EXPECT_THAT(named(found), IsEmpty());
  EXPECT_GT(found.nothing, 0.5);
}

TEST(CertainEffects, NamesCoggingOfTwoOrders) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::EffortScreen found =
      screened([](const Point& point) { return 0.01 * std::cos(7.0 * point.x) + 0.005 * std::sin(12.0 * point.x); });
  ASSERT_THAT(named(found), Contains("cogging"));
  EXPECT_EQ(found.certain.front().group, std::vector<std::string>{"cogging"});
  EXPECT_GE(found.certain.front().probability, 0.95);
  const sim::EffectEntry& cogging = *found.best().model.find("cogging");
  EXPECT_NEAR(cogging.at("period"), kTurn, 0.01);
  EXPECT_NEAR(std::abs(cogging.at("cosine_7")), 0.01, 0.001);
  EXPECT_NEAR(std::abs(cogging.at("sine_12")), 0.005, 0.001);
}

/// Only the position has the error; the torque does not.
TEST(CertainEffects, NamesAnErrorOfTheEncoderAndNotTheTorqueThatItSeemsToNeed) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  constexpr double kAmplitude = 0.004, kStep = kTurn / 200000.0;
  const auto turning = [](double t_s) {
    const double slow = kTurn * 0.2, fast = kTurn * 0.53;
    return Point{-40.0 / slow * std::cos(slow * t_s) - 20.0 / fast * std::cos(fast * t_s),
                 40.0 * std::sin(slow * t_s) + 20.0 * std::sin(fast * t_s),
                 40.0 * slow * std::cos(slow * t_s) + 20.0 * fast * std::cos(fast * t_s)};
  };
  const auto misread = [&](double from_s, double to_s, unsigned seed) {
    host::Record record = record_of(
        turning, [](const Point&) { return 0.0; }, from_s, to_s, seed);
    for (std::size_t k = 0; k < record.size(); ++k) {  // at evenly spaced times
      const double x = turning(from_s + record.t_s[k]).x;
      record.x[k] = kStep * std::round((x + kAmplitude * std::cos(3.0 * x)) / kStep);
    }
    return record;
  };
  const host::Record train = misread(0.0, 20.0, 1), validate = misread(31.0, 45.0, 2);
  sim::DriveDescription model = motor();
  model.data.encoder_resolution = kStep;
  const host::EffortScreen found =
      host::screen_effort(model, host::compare_on({&train}, model), host::compare_on({&validate}, model), 6);
  ASSERT_THAT(named(found), testing::ElementsAre("encoder_cyclic_error"));
  EXPECT_NEAR(found.best().model.find("encoder_cyclic_error")->at("cosine_3"), kAmplitude, 0.1 * kAmplitude);
  // With a model that has the effect, nothing remains to be explained.
  sim::DriveDescription knows = model;
  knows.effects.push_back(*found.best().model.find("encoder_cyclic_error"));
  const host::EffortScreen again =
      host::screen_effort(knows, host::compare_on({&train}, knows), host::compare_on({&validate}, knows), 6);
  EXPECT_THAT(named(again), IsEmpty());
}

TEST(CertainEffects, CannotTellAWeightFromAnOffset) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::EffortScreen found = screened([](const Point&) { return 0.008; });
  ASSERT_FALSE(found.certain.empty());
  EXPECT_THAT(found.certain.front().group, Contains("constant_torque"));
  EXPECT_THAT(found.certain.front().group, Contains("dac_offset"));
  EXPECT_LT(found.certain.front().after, 0.5 * found.certain.front().before);
}

TEST(CertainEffects, FindsTwoThatHideEachOther) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  // With a model that has only a weight, friction that differs by direction seems to vary with the speed, and vice
  // versa.
  const host::EffortScreen found =
      screened([](const Point& point) { return 0.006 + 0.3 * kViscous * std::abs(point.w); });
  EXPECT_THAT(named(found), Contains("viscous_asymmetry"));
  EXPECT_EQ(named(found).size(), 2U);
  EXPECT_LT(found.best().validate, 0.2 * found.base.validate);
}

TEST(CertainEffects, GivesASpringNoWeight) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const auto kinds_of = [](double weight, double stiffness) {
    return named(screened([=](const Point& point) { return weight + stiffness * point.x; }));
  };
  EXPECT_EQ(kinds_of(0.0, 0.0008), std::vector<std::string>{"spring_torque"});
  // The equilibrium of the spring is outside the travel.
  const std::vector<std::string> both = kinds_of(0.06, 0.0008);
  EXPECT_THAT(both, Contains("spring_torque"));
  EXPECT_EQ(both.size(), 2U);
}

TEST(CertainEffects, GivesABumpThatNoEffectIsToTheMemory) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::EffortScreen found =
      screened([](const Point& point) { return 0.015 * std::exp(-0.5 * std::pow(point.x - 3.0, 2)); });
  EXPECT_THAT(named(found), IsEmpty());
  EXPECT_GT(found.memory_log_odds, 10.0);
}

/// A crank: its torque depends on the acceleration and on the square of the speed, over a turn. Torque ripple explains
/// a part of it.
TEST(CertainEffects, HasNoNameForAnInertiaThatVariesOverATurn) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const auto fast_turning = [](double t_s) {
    const Point slow = slow_turning(t_s);
    return Point{5.0 * slow.x, 5.0 * slow.w, 5.0 * slow.a};
  };
  const host::EffortScreen found = screened(fast_turning, [](const Point& point) {
    return 0.4 * kInertia * (point.a * std::cos(point.x) - 0.5 * point.w * point.w * std::sin(point.x));
  });
  EXPECT_THAT(named(found), IsEmpty());
  EXPECT_GT(found.nothing, 0.95);
}
