// Fixed point against double precision, and against everything that could make it overflow.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/boards/pil/value_axis.hpp"
#include "firmware/core/axis.hpp"
#include "firmware/core/fixed_units.hpp"
#include "tests/firmware/linear_axis.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace {

using firmware::Axis;
using firmware::AxisParameters;
using firmware::FixedPoint;
using Traits = firmware::ScalarTraits<FixedPoint>;

double real(FixedPoint value) { return value.raw() / 2097152.0; }

TEST(FixedPoint, RoundsToNearestAndStaysAtItsLimits) {
  const auto most = FixedPoint::from_raw(FixedPoint::kMost), least = FixedPoint::from_raw(FixedPoint::kLeast);
  EXPECT_EQ(most + FixedPoint(1), most);
  EXPECT_EQ(least - FixedPoint(1), least);
  EXPECT_EQ(FixedPoint(0) - least, most);
  EXPECT_EQ(least * least, most);
  EXPECT_EQ(least * most, least);
  EXPECT_EQ(FixedPoint(5) / FixedPoint(0), most);
  EXPECT_EQ(FixedPoint(-5) / FixedPoint(0), least);
  EXPECT_EQ(FixedPoint::from(1e9), most);
  EXPECT_EQ(FixedPoint::from(std::nan("")), FixedPoint(0));
  EXPECT_EQ(Traits::from_integer(100'000), most);
  EXPECT_EQ(Traits::truncate(FixedPoint(-1.75f)), -1);
  EXPECT_EQ(Traits::truncate(least), -1024);
  EXPECT_EQ((FixedPoint(3) * FixedPoint(-0.5f)).raw(), FixedPoint(-1.5f).raw());
}

TEST(FixedPoint, OperationsAreWithinHalfAStepOfTheExactOrSaturated) {
  EXPECT_TRUE(rc::check("sum, difference, product", [](std::int32_t raw_a, std::int32_t raw_b) {
    const auto a = FixedPoint::from_raw(raw_a), b = FixedPoint::from_raw(raw_b);
    const auto expect_nearest = [](FixedPoint result, long double exact) {
      const long double limited = std::clamp(exact, -1024.0L, 1024.0L - 1.0L / 2097152.0L);
      RC_ASSERT(std::abs(result.raw() / 2097152.0L - limited) <= 0.5L / 2097152.0L);
    };
    const long double x = raw_a / 2097152.0L, y = raw_b / 2097152.0L;
    expect_nearest(a + b, x + y);
    expect_nearest(a - b, x - y);
    expect_nearest(a * b, x * y);
  }));
}

/// A drive, and a design for it by the paper's method, from a few random numbers.
AxisParameters<double> random_axis() {
  const auto within = [](double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 1'000'001) * 1e-6;
  };
  AxisParameters<double> p;
  p.sample_period_s = within(0.0002, 0.001);
  p.lead = within(0.5, 3.0);
  p.encoder_resolution = within(0.001, 0.01);
  p.dac_resolution_V = firmware_test::kDacResolution_V;
  p.dac_limit_V = 10.0;
  p.tachometer_gain = within(0.005, 0.05);
  p.tachometer_offset = within(-1.0, 1.0);
  const double inertia = within(0.003, 0.03), viscous = within(0.005, 0.05), effort_per_volt = within(1.0, 5.0);
  const double pole = -viscous / inertia, decay = std::exp(pole * p.sample_period_s);
  const double gain = effort_per_volt / viscous;  // rad/s per volt at standstill of the transient
  p.drive.Ad22 = decay;
  p.drive.Ad12 = p.lead * (1.0 - decay) / -pole;
  p.drive.Bd2 = gain * (1.0 - decay);
  p.drive.Bd1 = p.lead * gain * (p.sample_period_s - (1.0 - decay) / -pole);

  Eigen::Matrix3d A;
  A << 1.0, p.drive.Ad12, -p.drive.Bd1, 0.0, decay, -p.drive.Bd2, 0.0, 0.0, 1.0;
  const Eigen::Vector3d disturbance(0.0, 0.0, 1.0), input(p.drive.Bd1, p.drive.Bd2, 0.0);
  const Eigen::Matrix<double, 2, 3> C = Eigen::Matrix<double, 2, 3>::Identity();
  Eigen::Matrix2d R = Eigen::Matrix2d::Zero();
  R(0, 0) = p.encoder_resolution * p.encoder_resolution / 12.0;
  R(1, 1) = 0.05;
  const Eigen::Matrix3d Q = 0.01 * disturbance * disturbance.transpose() +
                            p.dac_resolution_V * p.dac_resolution_V / 12.0 * input * input.transpose();
  Eigen::Matrix3d P = Q;
  Eigen::Matrix<double, 3, 2> K;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Matrix3d predicted = A * P * A.transpose() + Q;
    K = predicted * C.transpose() * (C * predicted * C.transpose() + R).inverse();
    P = (Eigen::Matrix3d::Identity() - K * C) * predicted;
  }
  for (int row = 0; row < 3; ++row) p.Kobs[row] = {K(row, 0), K(row, 1)};

  // Ackermann's formula for two states: the closed loop's characteristic polynomial z^2 + c1 z + c0.
  const double natural = 2.0 * 3.14159265358979 * within(10.0, 40.0) * p.sample_period_s, damping = within(0.6, 0.95);
  const double radius = std::exp(-damping * natural);
  const double c1 = -2.0 * radius * std::cos(natural * std::sqrt(1.0 - damping * damping)), c0 = radius * radius;
  Eigen::Matrix2d Ad;
  Ad << 1.0, p.drive.Ad12, 0.0, decay;
  const Eigen::Vector2d Bd(p.drive.Bd1, p.drive.Bd2);
  Eigen::Matrix2d reach;
  reach << Bd, Ad * Bd;
  const Eigen::RowVector2d feedback =
      Eigen::RowVector2d(0.0, 1.0) * reach.inverse() * (Ad * Ad + c1 * Ad + c0 * Eigen::Matrix2d::Identity());
  p.Kc = {feedback(0), feedback(1)};

  p.friction = {{within(0.1, 2.0), within(0.1, 1.5), within(0.0, 0.01), within(0.5, 6.0), within(0.5, 6.0)},
                {within(0.1, 2.0), within(0.1, 1.5), within(0.0, 0.01), within(0.5, 6.0), within(0.5, 6.0)},
                within(0.2, 1.0)};
  p.friction_feedforward_on = *rc::gen::arbitrary<bool>();
  // The documented range: below 1024 counts a sample, and Kc2 times it below 1024 units; both with a third to spare.
  const firmware::FixedUnits<double> unit(p);
  const double feedback_gain = p.Kc[1] * unit.velocity / unit.volts;
  const double most_counts = 600.0 * std::min(1.0, 1.0 / feedback_gain);
  // Motion that the drive can follow: half its speed and acceleration at 10 V. Else the position error grows without
  // end.
  const double most_velocity = 0.5 * 10.0 * gain * p.lead,
               most_acceleration = 10.0 * effort_per_volt / inertia * p.lead;
  p.velocity_limit = std::min({within(50.0, 1000.0), most_velocity, most_counts * unit.travel_velocity});
  p.acceleration_limit = within(0.1, 0.4) * most_acceleration;
  p.jerk_limit = p.acceleration_limit / within(0.02, 0.1);
  return p;
}

/// The parameters that fixed point computes with, in its units, in double precision.
AxisParameters<double> as_double(const AxisParameters<FixedPoint>& q) {
  AxisParameters<double> p;
  const auto direction = [](const firmware::FrictionDirection<FixedPoint>& d) {
    return firmware::FrictionDirection<double>{real(d.static_V), real(d.coulomb_V), real(d.viscous_V_s_per_rad),
                                               real(d.omega1_rad_s), real(d.omega2_rad_s)};
  };
  p.sample_period_s = p.lead = p.encoder_resolution = 1.0;
  p.dac_resolution_V = real(q.dac_resolution_V);
  p.dac_limit_V = real(q.dac_limit_V);
  p.tachometer_gain = real(q.tachometer_gain);
  p.tachometer_offset = real(q.tachometer_offset);
  p.drive = {real(q.drive.Ad12), real(q.drive.Ad22), real(q.drive.Bd1), real(q.drive.Bd2)};
  for (std::size_t row = 0; row < 3; ++row) p.Kobs[row] = {real(q.Kobs[row][0]), real(q.Kobs[row][1])};
  p.Kc = {real(q.Kc[0]), real(q.Kc[1])};
  p.friction = {direction(q.friction.positive), direction(q.friction.negative), real(q.friction.blend_velocity_rad_s)};
  p.friction_feedforward_on = q.friction_feedforward_on;
  p.disturbance_cancellation_on = q.disturbance_cancellation_on;
  p.zero_phase_feedforward_on = q.zero_phase_feedforward_on;
  p.velocity_limit = real(q.velocity_limit);
  p.acceleration_limit = real(q.acceleration_limit);
  p.jerk_limit = real(q.jerk_limit);
  return p;
}

struct Differences {
  double position_counts = 0.0, velocity_counts = 0.0, disturbance_steps = 0.0;
  int dac_steps = 0;
};

/// Both axes see the same readings; the drive follows the fixed-point one.
Differences compare(const AxisParameters<double>& parameters, int periods) {
  const AxisParameters<FixedPoint> in_fixed = firmware::to_fixed(parameters);
  firmware_test::LinearAxis drive(parameters);
  drive.origin_counts = *rc::gen::inRange(-2'000'000'000, 2'000'000'000);
  firmware::boards::ValueAxis double_io, fixed_io;
  Axis<double, firmware::boards::ValueAxis> in_double_axis(double_io);
  Axis<FixedPoint, firmware::boards::ValueAxis> fixed_axis(fixed_io);
  RC_ASSERT(fixed_axis.configure(in_fixed) == firmware::ParameterError::none);
  RC_ASSERT(in_double_axis.configure(as_double(in_fixed)) == firmware::ParameterError::none);
  const auto noise = *rc::gen::container<std::vector<int>>(97, rc::gen::inRange(-20, 21));
  const double limit = real(in_fixed.velocity_limit);
  Differences worst;
  for (int k = 0; k < periods; ++k) {
    const hal::EncoderReading encoder = drive.encoder().read();
    hal::TachometerReading tachometer = drive.tachometer().read();
    tachometer.code += noise[static_cast<std::size_t>(k) % noise.size()];
    double_io.encoder().reading = fixed_io.encoder().reading = encoder;
    double_io.tachometer().reading = fixed_io.tachometer().reading = tachometer;
    if (k == 2) RC_ASSERT(fixed_axis.enable() && in_double_axis.enable());
    if (k % 400 == 10) {
      const double velocity = limit * *rc::gen::inRange(-100, 101) * 0.01;
      const auto raw = FixedPoint::from(velocity);
      fixed_axis.jog(raw);
      in_double_axis.jog(real(raw));
    }
    drive.disturbance_V = k % 700 < 350 ? 0.5 : -0.5;
    const auto& have = fixed_axis.step();
    const auto& want = in_double_axis.step();
    RC_ASSERT(have.reference == want.reference);
    RC_ASSERT(have.fault == firmware::AxisFault::none);
    const auto larger = [](double& most, double difference) { most = std::max(most, std::abs(difference)); };
    larger(worst.position_counts, real(have.estimate.offset) - want.estimate.offset);
    larger(worst.velocity_counts, real(have.estimate.velocity) - want.estimate.velocity);
    larger(worst.disturbance_steps, 4096.0 * (real(have.estimate.disturbance) - want.estimate.disturbance));
    worst.dac_steps = std::max(worst.dac_steps, std::abs(have.dac_code - want.dac_code));
    drive.drive_enable().set(fixed_io.drive_enable().on);
    drive.dac().write(fixed_io.dac().code);
    drive.advance();
  }
  return worst;
}

/// Where the two round a word differently, their estimators are told words that differ by one step. The estimate of the
/// disturbance answers a step of its input with some overshoot, so words that keep differing move it by less than two.
/// Disturbance cancellation is off: it would carry that into the next words.
TEST(FixedPoint, AnAxisStaysWithinItsBoundOfDoublePrecision) {
  Differences worst;
  EXPECT_TRUE(rc::check("estimate within 0.001 counts and two steps, converter within one step", [&worst] {
    const Differences seen = compare(random_axis(), 2000);
    RC_ASSERT(seen.position_counts < 1e-3);
    RC_ASSERT(seen.velocity_counts < 1e-3);
    RC_ASSERT(seen.disturbance_steps < 2.0);
    RC_ASSERT(seen.dac_steps <= 1);
    worst.position_counts = std::max(worst.position_counts, seen.position_counts);
    worst.velocity_counts = std::max(worst.velocity_counts, seen.velocity_counts);
    worst.disturbance_steps = std::max(worst.disturbance_steps, seen.disturbance_steps);
    worst.dac_steps = std::max(worst.dac_steps, seen.dac_steps);
  }));
  std::printf(
      "worst difference from double: position %.2g counts, velocity %.2g counts a sample, disturbance %.2g and "
      "output %d steps of the converter\n",
      worst.position_counts, worst.velocity_counts, worst.disturbance_steps, worst.dac_steps);
}

/// Runs under the sanitizer for undefined behaviour too, where a single overflow ends the test.
TEST(FixedPoint, NoReadingMakesAnAxisOverflow) {
  EXPECT_TRUE(rc::check("codes stay in range, the estimate stays ordered", [] {
    firmware::boards::ValueAxis io;
    Axis<FixedPoint, firmware::boards::ValueAxis> axis(io);
    RC_ASSERT(axis.configure(firmware::to_fixed(random_axis())) == firmware::ParameterError::none);
    for (int k = 0; k < 300; ++k) {
      io.encoder().reading = {*rc::gen::arbitrary<std::uint32_t>(), true};
      io.tachometer().reading = {*rc::gen::inRange(-(1 << 24), 1 << 24), true};
      if (k == 1) axis.enable();
      if (k % 50 == 5) axis.jog(FixedPoint::from_raw(*rc::gen::arbitrary<std::int32_t>()));
      const auto& telemetry = axis.step();
      RC_ASSERT(std::abs(telemetry.dac_code) <= 32767);
    }
  }));
}

/// These weights divide by the square of twice Bd1, and so are less exact than anything else: 1e-4 of a weight here.
TEST(FixedPoint, ZeroPhaseWeightsOfThePaperDrivesAreThoseOfDouble) {
  for (const auto& axis : {firmware_test::kPaperX, firmware_test::kPaperY}) {
    const auto in_fixed = firmware::to_fixed(firmware_test::parameters_of<double>(axis));
    const auto in_double = as_double(in_fixed);
    const auto have = firmware::zero_phase_feedforward(in_fixed.drive, in_fixed.Kc, FixedPoint(1));
    const auto want = firmware::zero_phase_feedforward(in_double.drive, in_double.Kc, 1.0);
    for (std::size_t i = 0; i < want.weight.size(); ++i)
      EXPECT_NEAR(real(have.weight[i]), want.weight[i], 1e-4 * std::abs(want.weight[i])) << "weight " << i;
  }
}

TEST(FixedPoint, ParametersThatDoNotFitAreRefused) {
  firmware::boards::ValueAxis io;
  Axis<FixedPoint, firmware::boards::ValueAxis> axis(io);
  auto parameters = firmware_test::parameters_of<double>(firmware_test::kPaperX);
  EXPECT_EQ(axis.configure(firmware::to_fixed(parameters)), firmware::ParameterError::none);
  parameters.Kc[0] = 1e9;
  EXPECT_EQ(axis.configure(firmware::to_fixed(parameters)), firmware::ParameterError::state_feedback);
}

}  // namespace
