// Fixed point compared with double precision, and tested with all inputs that could make it overflow.
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
  p.disturbance_cancellation_on = *rc::gen::arbitrary<bool>();
  p.zero_phase_feedforward_on = *rc::gen::arbitrary<bool>();
  if (p.zero_phase_feedforward_on)  // the documented range
    p.encoder_resolution = p.drive.Bd1 * 4096.0 * p.dac_resolution_V / within(0.1, 0.5);

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
  // Motion that the drive can follow: half its speed and acceleration at 10 V. Otherwise the position error grows
  // without bound.
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
  p.motion = q.motion;
  return p;
}

constexpr int kPeriods = 2000;  ///< of one run

struct Differences {
  double position_counts = 0.0, velocity_counts = 0.0, disturbance_steps = 0.0;
  int dac_steps = 0;
};

void enlarge(double& most, double difference) { most = std::max(most, std::abs(difference)); }

/// One period of a fixed-point axis, observed from outside.
struct Period {
  std::int32_t tachometer_code = 0;
  firmware::AxisTelemetry<FixedPoint> seen;
};

/// A drive under fixed-point control, jogged about. The reference is the same to the last bit in double precision.
std::vector<Period> run_fixed(const AxisParameters<double>& parameters, int periods) {
  firmware_test::LinearAxis drive(parameters);
  drive.origin_counts = *rc::gen::inRange(-2'000'000'000, 2'000'000'000);
  firmware::boards::ValueAxis io;
  Axis<FixedPoint, firmware::boards::ValueAxis> axis(io);
  Axis<double, firmware::boards::ValueAxis> in_double(io);
  const AxisParameters<FixedPoint> in_fixed = firmware::to_fixed(parameters);
  RC_ASSERT(in_double.configure(as_double(in_fixed)) == firmware::Refusal::none);
  RC_ASSERT(axis.configure(in_fixed) == firmware::Refusal::none);
  const auto noise = *rc::gen::container<std::vector<int>>(97, rc::gen::inRange(-20, 21));
  std::vector<Period> record;
  for (int k = 0; k < periods; ++k) {
    io.encoder().reading = drive.encoder().read();
    io.tachometer().reading = drive.tachometer().read();
    io.tachometer().reading.code += noise[static_cast<std::size_t>(k) % noise.size()];
    if (k == 2) RC_ASSERT(in_double.enable() && axis.enable());
    if (k % 400 == 10) {
      const auto velocity = FixedPoint::from(real(in_fixed.velocity_limit) * *rc::gen::inRange(-100, 101) * 0.01);
      in_double.jog(real(velocity));
      axis.jog(velocity);
    }
    const firmware::CountPosition reference = in_double.step().reference;
    drive.disturbance_V = k % 700 < 350 ? 0.5 : -0.5;
    record.push_back({io.tachometer().reading.code, axis.step()});
    RC_ASSERT(record.back().seen.fault == firmware::AxisFault::none);
    RC_ASSERT(record.back().seen.reference == reference);
    drive.drive_enable().set(io.drive_enable().on);
    drive.dac().write(io.dac().code);
    drive.advance();
  }
  return record;
}

/// Position, velocity and disturbance from one sample to the next.
Eigen::Matrix3d transition(const AxisParameters<double>& p) {
  Eigen::Matrix3d A;
  A << 1.0, p.drive.Ad12, -p.drive.Bd1, 0.0, p.drive.Ad22, -p.drive.Bd2, 0.0, 0.0, 1.0;
  return A;
}

/// Eqs. (43) and (50) or zero phase in matrices of double precision. From the measurements, references and outputs of
/// the fixed-point axis it computes the exact estimates and the exact next word. Eq. (19) is the axis's own:
/// FrictionPieces has a test of its error.
Differences judge(const AxisParameters<double>& p, const firmware::FrictionParameters<FixedPoint>& friction_in_fixed,
                  const std::vector<Period>& record) {
  const Eigen::Matrix3d A = transition(p);
  const Eigen::Vector3d B(p.drive.Bd1, p.drive.Bd2, 0.0);
  Eigen::Matrix<double, 3, 2> K;
  for (int row = 0; row < 3; ++row) K.row(row) << p.Kobs[row][0], p.Kobs[row][1];
  const auto feedforward = p.zero_phase_feedforward_on ? firmware::zero_phase_feedforward(p.drive, p.Kc, 1.0)
                                                       : firmware::backward_difference_feedforward(p.Kc);
  firmware::FrictionFeedforward<FixedPoint> friction;
  friction.configure(friction_in_fixed);

  const std::int64_t origin = record.front().seen.encoder_counts;
  const auto reference = [&](std::size_t k) {
    const firmware::CountPosition& at = record[k].seen.reference;
    return static_cast<double>(at.counts - origin) + static_cast<double>(at.fraction) * 0x1p-48;
  };
  Eigen::Vector3d estimate = Eigen::Vector3d::Zero();
  double input_V = 0.0;
  Differences worst;
  for (std::size_t k = 0; k + firmware::kPreviewSamples < record.size(); ++k) {
    const Period& period = record[k];
    const Eigen::Vector2d measured(static_cast<double>(period.seen.encoder_counts - origin),
                                   period.tachometer_code * p.tachometer_gain - p.tachometer_offset);
    const Eigen::Vector3d predicted = A * estimate + B * input_V;
    estimate = predicted + K * (measured - predicted.head<2>());
    enlarge(worst.position_counts, measured(0) + real(period.seen.estimate.offset) - estimate(0));
    enlarge(worst.velocity_counts, real(period.seen.estimate.velocity) - estimate(1));
    enlarge(worst.disturbance_steps, 4096.0 * (real(period.seen.estimate.disturbance) - estimate(2)));
    input_V = 0.0;
    if (!period.seen.enabled) continue;
    const auto velocity = [&](std::size_t j) { return reference(j) - reference(j - 1); };
    const double friction_V = p.friction_feedforward_on ? real(friction(FixedPoint::from(velocity(k + 1)))) : 0.0;
    double control_V = p.Kc[0] * (reference(k) - estimate(0)) - p.Kc[1] * estimate(1) + friction_V;
    control_V += feedforward.velocity * velocity(k);
    for (std::size_t i = 0; i < feedforward.change.size(); ++i)
      control_V += feedforward.change[i] * (velocity(k + i + 1) - velocity(k + i));
    if (p.disturbance_cancellation_on) control_V += estimate(2);
    const double most = std::floor(p.dac_limit_V / p.dac_resolution_V + 0.5) - 1.0;
    const double code = std::clamp(std::round(control_V / p.dac_resolution_V), -most, most);
    if (std::abs(reference(k) - estimate(0)) < 1023.0)  // beyond it saturates, as documented
      worst.dac_steps = std::max(worst.dac_steps, std::abs(period.seen.dac_code - static_cast<int>(code)));
    input_V = period.seen.dac_code * p.dac_resolution_V - friction_V;
  }
  return worst;
}

constexpr double kStep = 0x1p-21;  ///< of a number; a product is rounded by half of it, a quotient towards zero by all

/// Allowed differences of the estimates: every product of eq. (43) rounded by half a step in the worst direction, at
/// every sample, carried on by the observer itself: the sum of |M^k| r with M = (I - K C) A.
Differences most_estimate_error(const AxisParameters<double>& p) {
  const Eigen::Matrix3d A = transition(p);
  Eigen::Matrix3d left = Eigen::Matrix3d::Identity();
  Eigen::Vector3d velocity_gain;
  for (int row = 0; row < 3; ++row) {
    left(row, 0) -= p.Kobs[row][0];
    left(row, 1) -= p.Kobs[row][1];
    velocity_gain(row) = std::abs(p.Kobs[row][1]);
  }
  const Eigen::Vector3d rounded = left.cwiseAbs() * Eigen::Vector3d(kStep, kStep, 0.0) +
                                  Eigen::Vector3d::Constant(kStep) + 0.5 * kStep * velocity_gain;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d carried = Eigen::Matrix3d::Identity();
  for (int k = 0; k < kPeriods; ++k, carried = left * A * carried) sum += carried.cwiseAbs() * rounded;
  return {sum(0), sum(1), 4096.0 * sum(2), 0};
}

/// Allowed error of zero phase, V, at the top speed and acceleration: of the weight of a velocity,
/// (Kc2 + h) / (Ad12 + Bd1 h) with h = (1 - Ad22) / Bd2, and of the two taps of reference_feedforward.hpp.
double zero_phase_error_V(const AxisParameters<double>& p) {
  const double hold = (1.0 - p.drive.Ad22) / p.drive.Bd2, below = p.drive.Ad12 + p.drive.Bd1 * hold;
  const double weight = (p.Kc[1] + hold) / below;
  const double of_weight = std::abs(1.0 - weight * p.drive.Bd1) / below + 0.5 * weight / below + 1.0;
  const double n1 = p.drive.Bd1, n0 = p.drive.Ad12 * p.drive.Bd2 - p.drive.Ad22 * n1, sum = n0 + n1;
  const double d1 = p.drive.Bd1 * p.Kc[0] - 1.0 + p.drive.Bd2 * p.Kc[1] - p.drive.Ad22;
  const auto of_tap = [&](double numerator, double of_numerator) {
    return (of_numerator + 2.0 * std::abs(numerator / sum)) / (sum * sum) + 1.0 / std::abs(sum) + 1.0;
  };
  const double of_plus2 = of_tap(n0, 1.0), of_plus1 = of_tap(n1 + d1 * n0, std::abs(n0) + std::abs(d1) + 0.5);
  return kStep * (of_weight * p.velocity_limit + (of_plus1 + 3.0 * of_plus2) * p.acceleration_limit);
}

/// Allowed difference of the code, in steps of the converter: its own rounding, the differences of the estimates times
/// the gains, six rounded products and zero phase.
double most_dac_steps(const AxisParameters<double>& p, const Differences& seen) {
  double volts = p.Kc[0] * seen.position_counts + p.Kc[1] * seen.velocity_counts + 3.0 * kStep;
  if (p.zero_phase_feedforward_on) volts += zero_phase_error_V(p);
  double steps = 1.0 + volts / p.dac_resolution_V;
  if (p.disturbance_cancellation_on) steps += seen.disturbance_steps;
  return steps;
}

/// Friction feed-forward, zero phase and disturbance cancellation are each on in half of the axes. The estimate of the
/// disturbance is the least exact state: a rounding error of the predicted position becomes one that is 1 / Bd1 times
/// as large.
TEST(FixedPoint, EstimatesAndWordsStayWithinTheirBoundsOfDoublePrecision) {
  Differences worst;
  EXPECT_TRUE(rc::check("estimates within what rounded products make, converter within what these make", [&worst] {
    const AxisParameters<double> parameters = random_axis();
    const AxisParameters<FixedPoint> in_fixed = firmware::to_fixed(parameters);
    const AxisParameters<double> rounded = as_double(in_fixed);
    const Differences seen = judge(rounded, in_fixed.friction, run_fixed(parameters, kPeriods));
    const Differences most = most_estimate_error(rounded);
    RC_ASSERT(seen.position_counts <= most.position_counts);
    RC_ASSERT(seen.velocity_counts <= most.velocity_counts);
    RC_ASSERT(seen.disturbance_steps <= most.disturbance_steps);
    RC_ASSERT(seen.dac_steps <= most_dac_steps(rounded, seen));
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
    RC_ASSERT(axis.configure(firmware::to_fixed(random_axis())) == firmware::Refusal::none);
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

/// The weights of changes contain two divisions by twice Bd1, so they are the least exact: 1e-5 of a weight here.
TEST(FixedPoint, ZeroPhaseWeightsOfThePaperDrivesAreThoseOfDouble) {
  for (const auto& axis : {firmware_test::kPaperX, firmware_test::kPaperY}) {
    const auto in_fixed = firmware::to_fixed(firmware_test::parameters_of<double>(axis));
    const auto in_double = as_double(in_fixed);
    const auto have = firmware::zero_phase_feedforward(in_fixed.drive, in_fixed.Kc, FixedPoint(1));
    const auto want = firmware::zero_phase_feedforward(in_double.drive, in_double.Kc, 1.0);
    EXPECT_NEAR(real(have.velocity), want.velocity, 1e-6);
    for (std::size_t i = 0; i < want.change.size(); ++i)
      EXPECT_NEAR(real(have.change[i]), want.change[i], 1e-5 * std::abs(want.change[i])) << "weight " << i;
  }
}

TEST(FixedPoint, ParametersThatDoNotFitAreRefused) {
  firmware::boards::ValueAxis io;
  Axis<FixedPoint, firmware::boards::ValueAxis> axis(io);
  auto parameters = firmware_test::parameters_of<double>(firmware_test::kPaperX);
  EXPECT_EQ(axis.configure(firmware::to_fixed(parameters)), firmware::Refusal::none);
  parameters.Kc[0] = 1e9;
  EXPECT_EQ(axis.configure(firmware::to_fixed(parameters)), firmware::Refusal::state_feedback);
}

}  // namespace
