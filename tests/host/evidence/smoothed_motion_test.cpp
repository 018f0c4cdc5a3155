#include "host/evidence/smoothed_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/host/evidence/hand_made_record.hpp"

namespace {

constexpr double kDuration_s = 10.0;

/// The motion of HandMade::record(), by integration of its acceleration. Exact, because it is constant in each sample.
struct TrueMotion {
  std::vector<double> x, w;

  TrueMotion() {
    double at = 0.0, speed = 0.0;
    for (int k = 0; k < static_cast<int>(kDuration_s / HandMade::kPeriod_s); ++k) {
      x.push_back(at);
      w.push_back(speed);
      const double a = HandMade::acceleration((k + 0.5) * HandMade::kPeriod_s);
      at += HandMade::model().data.lead * (speed + 0.5 * a * HandMade::kPeriod_s) * HandMade::kPeriod_s;
      speed += a * HandMade::kPeriod_s;
      if (std::abs(speed) < 1e-9) speed = 0.0;
    }
  }
};

host::MotionSmoother smooth(const host::Record& record) {
  return {record, HandMade::model().data, HandMade::kInertia, HandMade::kViscous, HandMade::kCoulomb};
}

double rms(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

TEST(SmoothedMotion, IsAsNearToTheTruthAsItSays) {
  const TrueMotion truth;
  const host::MotionSmoother smoother = smooth(HandMade::record(kDuration_s));
  const host::SmoothedMotion& motion = smoother.motion();
  ASSERT_EQ(motion.x.size(), truth.x.size());
  std::vector<double> x_off, w_off;
  std::size_t x_within = 0, w_within = 0;
  for (std::size_t k = 0; k < truth.x.size(); ++k) {
    if (motion.standing[k]) continue;
    x_off.push_back(motion.x[k] - truth.x[k]);
    w_off.push_back(motion.w[k] - truth.w[k]);
    if (std::abs(x_off.back()) <= 2.0 * std::sqrt(motion.x_variance[k])) ++x_within;
    if (std::abs(w_off.back()) <= 2.0 * std::sqrt(motion.w_variance[k])) ++w_within;
  }
  // Two standard deviations contain 95 % of normal errors.
  EXPECT_GE(x_within, 0.95 * static_cast<double>(x_off.size()));
  EXPECT_GE(w_within, 0.95 * static_cast<double>(w_off.size()));
  const double resolution = HandMade::model().data.encoder_resolution, lead = HandMade::model().data.lead;
  // Better than the encoder's own quantisation (eq. 12), and ten times better than its difference quotient.
  EXPECT_LT(rms(x_off), resolution / std::sqrt(12.0));
  EXPECT_LT(rms(w_off), 0.1 * resolution / std::sqrt(6.0) / HandMade::kPeriod_s / lead);
}

/// Errors of the smoothed speed at a steady number of counts per sample, over the standard deviation that the smoother
/// states.
double speed_error_over_stated(double counts_a_sample) {
  const sim::DataSheet data = HandMade::model().data;
  const double w = counts_a_sample * data.encoder_resolution / data.lead / HandMade::kPeriod_s;
  host::Record record;
  record.path = "steady.csv";
  record.columns = {"t_s", "u_V", "x_mm"};
  record.sample_period_s = HandMade::kPeriod_s;
  for (int k = 0; k < 4000; ++k) {
    const double t_s = k * HandMade::kPeriod_s, x = data.lead * w * t_s + 0.3 * data.encoder_resolution;
    record.t_s.push_back(t_s);
    record.u_V.push_back((HandMade::kViscous * w + HandMade::kCoulomb) / data.effort_per_volt());
    record.x.push_back(std::round(x / data.encoder_resolution) * data.encoder_resolution);
  }
  const host::SmoothedMotion motion = smooth(record).motion();
  std::vector<double> off;
  for (std::size_t k = 200; k + 200 < motion.w.size(); ++k)
    off.push_back((motion.w[k] - w) / std::sqrt(motion.w_variance[k]));
  return rms(off);
}

/// Near a whole number of counts per sample, the errors of successive counts are alike (1.7 standard deviations if they
/// are assumed independent).
TEST(SmoothedMotion, StatesTheErrorOfCountsThatRepeat) {
  EXPECT_LT(speed_error_over_stated(4.05), 1.2);
  EXPECT_LT(speed_error_over_stated(3.02), 1.2);
  EXPECT_LT(speed_error_over_stated(4.37), 1.2);
}

TEST(SmoothedMotion, KnowsWhereTheAxisStands) {
  const TrueMotion truth;
  const host::MotionSmoother smoother = smooth(HandMade::record(kDuration_s));
  const host::SmoothedMotion& motion = smoother.motion();
  for (std::size_t k = 0; k < truth.w.size(); ++k) {
    if (motion.standing[k]) {
      EXPECT_EQ(motion.w[k], 0.0);
      // One count of travel from rest at 100 rad/s^2: 0.5 rad/s.
      EXPECT_LE(std::abs(truth.w[k]), 0.51) << k;
    }
  }
  EXPECT_TRUE(motion.standing[2250]);
  EXPECT_TRUE(motion.standing[4750]);
  EXPECT_FALSE(motion.standing[1000]);
}

TEST(SmoothedMotion, OwesNothingToTheTachometer) {
  host::Record record = HandMade::record(kDuration_s);
  const host::SmoothedMotion with = smooth(record).motion();
  for (double& w : record.w) w = 1.2 * w + 3.0;
  const host::SmoothedMotion without = smooth(record).motion();
  EXPECT_EQ(with.x, without.x);
  EXPECT_EQ(with.w, without.w);
}

TEST(SmoothedMotion, ShiftsAddUpToTheSmoothingOfTheShiftedRecord) {
  host::Record record = HandMade::record(kDuration_s);
  const host::MotionSmoother smoother = smooth(record);
  const std::size_t row = 1000;
  const std::vector<double> reading(2 * smoother.reach(), 0.5);
  const host::ShiftWeights::Shift shift = smoother.shift_weights(row).shift(reading, {});
  // A constant offset of the encoder shifts the travel by this offset, and does not change the speed.
  EXPECT_NEAR(shift.x, 0.5, 1e-3);
  EXPECT_NEAR(shift.w, 0.0, 1e-3 * std::abs(smoother.motion().w[row]));
}

}  // namespace
