// Records from an equation of motion: speed and acceleration are exact, and the torque is what they need.
#include "host/evidence/record_zeros.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

#include "host/evidence/measurement_gate.hpp"
#include "host/model/model_file.hpp"
#include "host/record/read_record.hpp"

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kPeriod_mm = 2.5, kLead_mm = 10.0 / kTurn;

sim::DataSheet sheet() {
  sim::DataSheet data;
  data.amplifier_gain_A_per_V = 1.0;
  data.torque_constant_Nm_per_A = 1.0;
  data.lead = kLead_mm;
  return data;
}

/// Torque beyond inertia and friction, over travel from the machine's own zero (mm) and speed (rad/s).
using Pattern = std::function<double(double x_mm, double w)>;

double cogging(double x_mm, double /*w*/) {
  return 0.15 * std::cos(kTurn * x_mm / kPeriod_mm) + 0.05 * std::sin(kTurn * 2.0 * x_mm / kPeriod_mm);
}

/// Strokes of 30 mm with a faster swing of 2 mm, 8 s at 1 kHz. The encoder's zero is at `zero_mm`.
host::Record strokes(double stroke_Hz, double zero_mm, const Pattern& pattern) {
  host::Record record;
  record.path = "strokes.csv";
  record.sample_period_s = 1e-3;
  for (int k = 0; k < 8000; ++k) {
    const double t = 1e-3 * k, slow = kTurn * stroke_Hz, fast = kTurn * 3.1;
    const double x = 15.0 * std::sin(slow * t) + 1.0 * std::sin(fast * t);
    const double w = (15.0 * slow * std::cos(slow * t) + 1.0 * fast * std::cos(fast * t)) / kLead_mm;
    const double a = -(15.0 * slow * slow * std::sin(slow * t) + 1.0 * fast * fast * std::sin(fast * t)) / kLead_mm;
    record.t_s.push_back(t);
    record.x.push_back(x - zero_mm);
    record.i_A.push_back(0.006 * a + 0.03 * w + (w > 0.0 ? 0.8 : -0.8) + pattern(x, w));
  }
  return record;
}

std::vector<host::AnotherZero> zeros_of(const host::Record& first, const host::Record& second) {
  return host::other_zeros({&first, &second}, sheet());
}

/// Distance to the nearest whole number of periods, mm.
double off_period(double x_mm) { return std::abs(std::remainder(x_mm, kPeriod_mm)); }

TEST(RecordZeros, AreFoundByWhatRepeatsAlongTheTravel) {
  for (const double zero_mm : {0.6, 1.25, -0.9}) {
    const host::Record first = strokes(0.4, 0.0, cogging), second = strokes(0.23, zero_mm, cogging);
    const auto found = zeros_of(first, second);
    ASSERT_EQ(found.size(), 1U) << zero_mm;
    const double sign = found.front().record == 1 ? 1.0 : -1.0;
    EXPECT_LT(off_period(sign * found.front().shift - zero_mm), 0.05) << zero_mm;
    EXPECT_NEAR(found.front().period, kPeriod_mm, 0.01);
  }
}

TEST(RecordZeros, AreSilentWhereTheyAgreeOrNothingTells) {
  EXPECT_TRUE(zeros_of(strokes(0.4, 0.0, cogging), strokes(0.23, 0.0, cogging)).empty());
  EXPECT_TRUE(zeros_of(strokes(0.4, 0.0, cogging), strokes(0.23, kPeriod_mm, cogging)).empty());
  const auto nothing = [](double, double) { return 0.0; };
  EXPECT_TRUE(zeros_of(strokes(0.4, 0.0, nothing), strokes(0.23, 0.6, nothing)).empty());
  // A different pattern is not a different zero: another size, or another period.
  const auto larger = [](double x, double w) { return 2.0 * cogging(x, w); };
  EXPECT_TRUE(zeros_of(strokes(0.4, 0.0, cogging), strokes(0.23, 0.6, larger)).empty());
  const auto wider = [](double x, double w) { return cogging(0.8 * x, w); };
  EXPECT_TRUE(zeros_of(strokes(0.4, 0.0, cogging), strokes(0.23, 0.6, wider)).empty());
}

TEST(RecordZeros, AFrictionThatTurnsWithTheMotionIsNoOtherZero) {
  const auto friction = [](double x, double w) { return (w > 0.0 ? 1.0 : -1.0) * cogging(x, w); };
  const auto one_way = [&](double sign) {
    host::Record record = strokes(0.1, 0.0, friction);
    for (std::vector<double>* column : {&record.t_s, &record.x, &record.i_A}) {
      std::vector<double> kept;  // a quarter of a stroke, all in one direction
      const std::size_t begin = sign > 0.0 ? 0 : 3000;
      kept.assign(column->begin() + static_cast<std::ptrdiff_t>(begin),
                  column->begin() + static_cast<std::ptrdiff_t>(begin + 2000));
      *column = kept;
    }
    return record;
  };
  EXPECT_TRUE(zeros_of(one_way(1.0), one_way(-1.0)).empty());
}

TEST(RecordZeros, AreSharedByTheGate) {
  const std::filesystem::path folder = std::filesystem::path(AXIS_TEST_DATA) / "drive-cases" / "single" / "case-00";
  const sim::DriveDescription model = host::read_model((folder / "model.toml").string());
  const host::Record jog = host::read_record((folder / "train-jog.csv").string());
  host::Record homed_anew = host::read_record((folder / "validate.csv").string());
  const std::vector<double> before = homed_anew.x;
  constexpr double kShift_mm = 0.45;
  for (double& x : homed_anew.x) x += kShift_mm;
  const host::Measurements shared = host::MeasurementGate(model).admit({jog}, {homed_anew});
  ASSERT_EQ(shared.log().size(), 1U);
  EXPECT_EQ(log_fault_family(shared.log().front().kind), "zero");
  EXPECT_FALSE(shared.log().front().fatal);
  const double moved =
      shared.validation().front().x.front() - before.front() - shared.training().front().x.front() + jog.x.front();
  EXPECT_LT(std::abs(std::remainder(moved, 1.25)), 0.06);
  const host::Measurements logged =
      host::MeasurementGate(model, {.accepted = {}, .as_logged = true}).admit({jog}, {homed_anew});
  EXPECT_EQ(logged.validation().front().x, homed_anew.x);
}

}  // namespace
