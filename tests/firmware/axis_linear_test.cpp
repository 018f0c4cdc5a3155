// The control law with a linear drive: poles, tracking, resolution, faults, switches.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "firmware/core/axis.hpp"
#include "tests/firmware/linear_axis.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace {

using firmware::Axis;
using firmware::AxisFault;
using firmware::AxisParameters;
using firmware::CountPosition;
using firmware::kOneCount;
using firmware::Refusal;
using firmware_test::kPaperX;
using firmware_test::kPaperY;
using firmware_test::LinearAxis;
using firmware_test::PaperAxis;
using firmware_test::parameters_of;

static_assert(hal::AxisHal<LinearAxis>);

/// Change of the disturbance estimate by one encoder count of innovation: its ripple due to quantisation.
double count_ripple_V(const PaperAxis& axis) { return -axis.Kobs[2][0] * firmware_test::kEncoderResolution_mm; }

/// Double precision and ideal sensors, so that only the arithmetic of the control law matters.
AxisParameters<double> fine(const PaperAxis& axis) {
  AxisParameters<double> p = parameters_of<double>(axis);
  p.encoder_resolution = 1e-8;
  p.dac_resolution_V = 1e-6;
  p.dac_limit_V = 8.0;
  p.tachometer_gain = 1e-8;
  p.velocity_limit = 0.1;  // keeps the limits in the references' range at this resolution
  p.acceleration_limit = 10.0;
  p.jerk_limit = 1000.0;
  return p;
}

/// Poles of the linear recurrence that a sequence obeys, by least squares (Prony); sorted by real, then imaginary part.
std::vector<std::complex<double>> poles_of(const std::vector<double>& sequence, int order) {
  const int rows = static_cast<int>(sequence.size()) - order;
  Eigen::MatrixXd past(rows, order);
  Eigen::VectorXd next(rows);
  for (int row = 0; row < rows; ++row) {
    for (int lag = 0; lag < order; ++lag) past(row, lag) = sequence[row + order - 1 - lag];
    next(row) = sequence[row + order];
  }
  const Eigen::VectorXd coefficients = past.colPivHouseholderQr().solve(next);
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(order, order);
  companion.row(0) = coefficients.transpose();
  for (int i = 1; i < order; ++i) companion(i, i - 1) = 1.0;
  const Eigen::VectorXcd values = companion.eigenvalues();
  std::vector<std::complex<double>> poles(values.data(), values.data() + order);
  std::sort(poles.begin(), poles.end(), [](auto a, auto b) {
    return std::abs(a.real() - b.real()) > 1e-6 ? a.real() < b.real() : a.imag() < b.imag();
  });
  return poles;
}

class LinearLoop : public testing::TestWithParam<const PaperAxis*> {};
INSTANTIATE_TEST_SUITE_P(PaperAxes, LinearLoop, testing::Values(&kPaperX, &kPaperY),
                         [](const auto& axis) { return axis.param == &kPaperX ? "x" : "y"; });

TEST_P(LinearLoop, StepOfTheReferenceDecaysWithThePolesThatWerePlaced) {
  const AxisParameters<double> p = fine(*GetParam());
  LinearAxis drive(p);
  Axis<double, LinearAxis> axis(drive);
  ASSERT_EQ(axis.configure(p), Refusal::none);
  axis.step();
  ASSERT_TRUE(axis.enable());

  const double step_mm = 1e-4;
  std::vector<double> error;
  for (int k = 0; k < 60; ++k) {
    axis.step_with(k == 0 ? static_cast<firmware::Increment>(step_mm / p.encoder_resolution) * kOneCount : 0);
    drive.advance();
    // The reference arrives after the preview; its velocity, eq. (52), is a pulse in that sample and 0 afterwards.
    if (k > firmware::kPreviewSamples) error.push_back((drive.position - step_mm) / step_mm);
  }
  const auto poles = poles_of(error, 2);
  // 30 Hz, damping 0.7 (Table 1), mapped by z = exp(s Ts).
  const double wn = 2.0 * std::numbers::pi * 30.0;
  const std::complex<double> s(-0.7 * wn, wn * std::sqrt(1.0 - 0.49));
  const std::complex<double> placed = std::exp(s * p.sample_period_s);
  EXPECT_NEAR(poles[1].real(), placed.real(), 2e-4);
  EXPECT_NEAR(poles[1].imag(), placed.imag(), 2e-4);
  EXPECT_NEAR(std::abs(poles[0] - std::conj(poles[1])), 0.0, 1e-12);
}

TEST_P(LinearLoop, EstimateApproachesADisturbanceStepWithTheObserversPoles) {
  const AxisParameters<double> p = fine(*GetParam());
  LinearAxis drive(p);
  Axis<double, LinearAxis> axis(drive);
  ASSERT_EQ(axis.configure(p), Refusal::none);
  axis.step();
  ASSERT_TRUE(axis.enable());
  drive.disturbance_V = 1.0;
  std::vector<double> error;
  for (int k = 0; k < 40; ++k) {
    drive.advance();
    error.push_back(axis.step().estimate.disturbance - drive.disturbance_V);
  }
  EXPECT_NEAR(error.back() / drive.disturbance_V, 0.0, 1e-4);
  const auto poles = poles_of(error, 3);
  std::vector<std::complex<double>> golden;
  for (const auto& pole : GetParam()->observer_poles) golden.emplace_back(pole[0], pole[1]);
  std::sort(golden.begin(), golden.end(), [](auto a, auto b) {
    return std::abs(a.real() - b.real()) > 1e-6 ? a.real() < b.real() : a.imag() < b.imag();
  });
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::abs(poles[i] - golden[i]), 0.0, 1e-4) << i;
}

struct Response {
  double phase_rad;
  double gain;
};

/// Steady response of true position to a sinusoidal reference, by correlation over whole periods.
Response sinusoid_response(const PaperAxis& paper, bool zero_phase, double frequency_Hz) {
  AxisParameters<double> p = fine(paper);
  p.zero_phase_feedforward_on = zero_phase;
  LinearAxis drive(p);
  Axis<double, LinearAxis> axis(drive);
  EXPECT_EQ(axis.configure(p), Refusal::none);
  axis.step();
  EXPECT_TRUE(axis.enable());
  const double amplitude_mm = 1e-4;
  const double omega = 2.0 * std::numbers::pi * frequency_Hz;
  const int period = static_cast<int>(std::lround(1.0 / (frequency_Hz * p.sample_period_s)));
  const int settling = 1000 / period * period;
  CountPosition sent{};
  std::complex<double> reference, position;
  for (int k = 0; k < settling + 4 * period; ++k) {
    const double counts = amplitude_mm * (1.0 - std::cos(omega * (k + 1) * p.sample_period_s)) / p.encoder_resolution;
    const CountPosition target{
        static_cast<std::int64_t>(std::floor(counts)),
        static_cast<std::int64_t>((counts - std::floor(counts)) * static_cast<double>(kOneCount))};
    const CountPosition change = target - sent;
    const auto& telemetry = axis.step_with(change.counts * kOneCount + change.fraction);
    sent = target;
    if (k >= settling) {
      const std::complex<double> wave = std::polar(1.0, -omega * k * p.sample_period_s);
      reference += wave * firmware::counts_from<double>(0, telemetry.reference) * p.encoder_resolution;
      position += wave * drive.position;
    }
    drive.advance();
  }
  EXPECT_EQ(axis.telemetry().fault, AxisFault::none);
  const std::complex<double> ratio = position / reference;
  return {std::arg(ratio), std::abs(ratio)};
}

TEST_P(LinearLoop, ZeroPhaseFeedforwardTracksASinusoidWithoutPhaseErrorAndWithThePredictedGain) {
  for (const double frequency_Hz : {2.0, 10.0, 40.0, 100.0}) {
    const Response response = sinusoid_response(*GetParam(), true, frequency_Hz);
    EXPECT_NEAR(response.phase_rad, 0.0, 1e-4) << frequency_Hz << " Hz";
    // Tomizuka's N(z) N(1/z) / N(1)^2 with the zero of the sampled drive, written out here.
    const double n1 = GetParam()->Bd1;
    const double n0 = GetParam()->Ad12 * GetParam()->Bd2 - GetParam()->Ad22 * GetParam()->Bd1;
    const double angle = 2.0 * std::numbers::pi * frequency_Hz * firmware_test::kSamplePeriod_s;
    const double expected = std::norm(n1 + n0 * std::polar(1.0, angle)) / ((n0 + n1) * (n0 + n1));
    EXPECT_NEAR(response.gain, expected, 1e-4) << frequency_Hz << " Hz";
  }
}

TEST_P(LinearLoop, WithoutZeroPhaseFeedforwardTheSameSinusoidLags) {
  EXPECT_LT(sinusoid_response(*GetParam(), false, 10.0).phase_rad, -0.05);
}

/// D/A words of a float axis that starts at the given reading and makes a move with jogs around it.
std::vector<std::int32_t> words_from(std::int64_t origin_counts) {
  const auto p = parameters_of<float>(kPaperX);
  LinearAxis drive(p);
  drive.origin_counts = origin_counts;
  Axis<float, LinearAxis> axis(drive);
  EXPECT_EQ(axis.configure(p), Refusal::none);
  axis.step();
  EXPECT_TRUE(axis.enable());
  std::vector<std::int32_t> words;
  for (int k = 0; k < 1500; ++k) {
    if (k == 0) axis.jog(40.0f);
    if (k == 300) axis.jog(-25.5f);
    if (k == 600) axis.stop();
    if (k == 900) {
      CountPosition target = axis.telemetry().reference;
      target.counts += 5000;
      EXPECT_TRUE(axis.start(axis.plan_move_to(target).plan));
    }
    words.push_back(axis.step().dac_code);
    drive.advance();
  }
  EXPECT_EQ(axis.telemetry().fault, AxisFault::none);
  return words;
}

TEST(Resolution, TheControlSignalIsTheSameToTheLastBitAtAnyDistanceFromZero) {
  const auto at_zero = words_from(0);
  EXPECT_GT(*std::max_element(at_zero.begin(), at_zero.end()), 1000);
  EXPECT_EQ(words_from(static_cast<std::int64_t>(10000.0 / firmware_test::kEncoderResolution_mm)), at_zero);  // 10 m
  EXPECT_EQ(words_from(std::int64_t{1} << 30), at_zero);                                                      // 2.6 km
  EXPECT_EQ(words_from((std::int64_t{1} << 31) - 3000), at_zero);  // the counter passes 2^31 on the way
  EXPECT_EQ(words_from(-5000), at_zero);                           // the counter passes 2^32 on the way
}

TEST(Resolution, TenMetresEndWithinHalfACountOfTheTarget) {
  auto p = parameters_of<float>(kPaperX);
  p.zero_phase_feedforward_on = true;
  p.velocity_limit = 2000.0f;
  p.acceleration_limit = 5000.0f;
  LinearAxis drive(p);
  Axis<float, LinearAxis> axis(drive);
  ASSERT_EQ(axis.configure(p), Refusal::none);
  axis.step();
  ASSERT_TRUE(axis.enable());
  const CountPosition target = CountPosition::at(4096000);
  const auto planned = axis.plan_move_to(target);
  ASSERT_EQ(planned.refusal, firmware::Refusal::none);
  ASSERT_TRUE(axis.start(planned.plan));
  double worst_mm = 0.0;
  int samples = 0;
  while (!axis.is_at_rest() && samples < 20000) {
    const auto& telemetry = axis.step();
    const double estimate_mm =
        static_cast<double>(telemetry.estimate.anchor_counts) * firmware_test::kEncoderResolution_mm +
        static_cast<double>(telemetry.estimate.offset);
    worst_mm = std::max(worst_mm, std::abs(estimate_mm - drive.position));
    drive.advance();
    ++samples;
  }
  for (int k = 0; k < 200; ++k) {
    axis.step();
    drive.advance();
  }
  EXPECT_EQ(axis.telemetry().reference, target);
  EXPECT_LT(worst_mm, firmware_test::kEncoderResolution_mm) << "the estimate stays within a count all the way";
  EXPECT_NEAR(drive.position, 10000.0, 0.5 * firmware_test::kEncoderResolution_mm);
}

TEST(DisturbanceCancellation, RemovesTheStandingErrorThatStateFeedbackLeaves) {
  for (const bool cancel : {false, true}) {
    auto p = parameters_of<float>(kPaperX);
    p.disturbance_cancellation_on = cancel;
    LinearAxis drive(p);
    Axis<float, LinearAxis> axis(drive);
    ASSERT_EQ(axis.configure(p), Refusal::none);
    axis.step();
    ASSERT_TRUE(axis.enable());
    drive.disturbance_V = 0.5;
    for (int k = 0; k < 1000; ++k) {
      axis.step();
      drive.advance();
    }
    EXPECT_NEAR(static_cast<double>(axis.telemetry().estimate.disturbance), 0.5, count_ripple_V(kPaperX));
    // Without it, Kc1 times the error has to balance the disturbance.
    EXPECT_NEAR(drive.position, cancel ? 0.0 : -0.5 / kPaperX.Kc[0], 2e-3);
  }
}

TEST(DisturbanceCancellation, OnTopOfFrictionFeedforwardDoesNotCountFrictionTwice) {
  auto p = parameters_of<float>(kPaperX);
  p.friction_feedforward_on = true;
  p.disturbance_cancellation_on = true;
  LinearAxis drive(p);
  Axis<float, LinearAxis> axis(drive);
  ASSERT_EQ(axis.configure(p), Refusal::none);
  axis.step();
  ASSERT_TRUE(axis.enable());
  axis.jog(50.0f);
  for (int k = 0; k < 1000; ++k) {
    const auto& telemetry = axis.step();
    drive.disturbance_V = static_cast<double>(telemetry.friction_V);  // the drive has exactly the friction that is fed
    drive.advance();
  }
  EXPECT_GT(axis.telemetry().friction_V, 0.5f);
  EXPECT_NEAR(static_cast<double>(axis.telemetry().estimate.disturbance), 0.0, count_ripple_V(kPaperX));
  EXPECT_NEAR(drive.velocity * firmware_test::kLead_mm_per_rad, 50.0, 0.1);
}

TEST(Saturation, IsReportedAndTheModelIsGivenWhatTheConverterPutOut) {
  auto p = parameters_of<float>(kPaperX);
  p.dac_limit_V = 0.5f;
  LinearAxis drive(p);
  Axis<float, LinearAxis> axis(drive);
  ASSERT_EQ(axis.configure(p), Refusal::none);
  axis.step();
  ASSERT_TRUE(axis.enable());
  bool saturated = false;
  for (int k = 0; k < 300; ++k) {
    const auto& telemetry = axis.step_with(k < 10 ? 100 * kOneCount : 0);
    saturated = saturated || telemetry.saturated;
    ASSERT_LT(std::abs(drive.command_V), 0.5);
    ASSERT_NEAR(static_cast<double>(telemetry.estimate.disturbance), 0.0, 2.0 * count_ripple_V(kPaperX));
    drive.advance();
  }
  EXPECT_TRUE(saturated);
}

class AxisFaults : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(axis.configure(parameters), Refusal::none);
    axis.step();
    ASSERT_TRUE(axis.enable());
    axis.jog(20.0f);
    for (int k = 0; k < 200; ++k) {
      axis.step();
      drive.advance();
    }
    ASSERT_NE(drive.command_V, 0.0);
    ASSERT_TRUE(drive.drive_enable().on);
  }

  void expect_stopped_by(AxisFault fault) {
    axis.step();
    EXPECT_EQ(axis.telemetry().fault, fault);
    EXPECT_FALSE(axis.telemetry().enabled);
    EXPECT_FALSE(drive.drive_enable().on);
    EXPECT_EQ(axis.telemetry().dac_code, 0);
    EXPECT_FALSE(axis.enable()) << "the fault is latched";
    EXPECT_FALSE(axis.jog(1.0f));
  }

  AxisParameters<float> parameters = parameters_of<float>(kPaperX);
  LinearAxis drive{parameters};
  Axis<float, LinearAxis> axis{drive};
};

TEST_F(AxisFaults, InvalidEncoderOpensTheLoop) {
  drive.encoder().valid = false;
  expect_stopped_by(AxisFault::encoder_invalid);
  EXPECT_EQ(drive.command_V, 0.0);
}

TEST_F(AxisFaults, InvalidTachometerOpensTheLoop) {
  drive.tachometer().valid = false;
  expect_stopped_by(AxisFault::tachometer_invalid);
  EXPECT_EQ(drive.command_V, 0.0);
}

TEST_F(AxisFaults, FailedConverterOpensTheLoop) {
  drive.dac().works = false;
  expect_stopped_by(AxisFault::dac_write_failed);
}

TEST(AxisFault, AControlSignalThatIsNotANumberNeverReachesTheConverter) {
  auto p = parameters_of<float>(kPaperX);
  p.Kobs[1][1] = 1e30f;  // finite, so it is accepted, and diverges within a few samples
  p.disturbance_cancellation_on = true;
  LinearAxis drive(p);
  Axis<float, LinearAxis> axis(drive);
  ASSERT_EQ(axis.configure(p), Refusal::none);
  axis.step();
  ASSERT_TRUE(axis.enable());
  drive.velocity = 1.0;
  for (int k = 0; k < 20; ++k) {
    axis.step();
    drive.advance();
  }
  EXPECT_EQ(axis.telemetry().fault, AxisFault::state_not_a_number);
  EXPECT_EQ(drive.command_V, 0.0);
  EXPECT_FALSE(drive.drive_enable().on);
}

TEST_F(AxisFaults, AfterTheCauseIsGoneTheAxisHoldsWhereItStands) {
  drive.encoder().valid = false;
  expect_stopped_by(AxisFault::encoder_invalid);
  drive.encoder().valid = true;
  drive.velocity = 0.0;
  drive.position = 7.0;
  axis.clear_fault();
  axis.step();
  ASSERT_TRUE(axis.enable());
  for (int k = 0; k < 500; ++k) {
    axis.step();
    drive.advance();
    ASSERT_NEAR(drive.position, 7.0, firmware_test::kEncoderResolution_mm);
  }
}

TEST_F(AxisFaults, ParametersStayWhileEnabled) {
  EXPECT_EQ(axis.configure(parameters), Refusal::controller_is_enabled);
}

TEST(AxisParameterCheck, NamesWhatIsWrong) {
  const AxisParameters<float> good = parameters_of<float>(kPaperX);
  ASSERT_EQ(firmware::check(good), Refusal::none);
  const auto error_after = [&](auto change) {
    AxisParameters<float> p = good;
    change(p);
    return firmware::check(p);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(error_after([](auto& p) { p.sample_period_s = 0.0f; }), Refusal::sample_period);
  EXPECT_EQ(error_after([&](auto& p) { p.lead = nan; }), Refusal::lead);
  EXPECT_EQ(error_after([](auto& p) { p.encoder_resolution = -1.0f; }), Refusal::encoder_resolution);
  EXPECT_EQ(error_after([](auto& p) { p.dac_resolution_V = 0.0f; }), Refusal::dac_resolution);
  EXPECT_EQ(error_after([](auto& p) { p.dac_limit_V = 1e-4f; }), Refusal::dac_limit);
  EXPECT_EQ(error_after([](auto& p) { p.tachometer_gain = 0.0f; }), Refusal::tachometer_gain);
  EXPECT_EQ(error_after([](auto& p) { p.drive.Ad22 = 1.01f; }), Refusal::drive_model);
  EXPECT_EQ(error_after([&](auto& p) { p.Kobs[2][1] = nan; }), Refusal::kalman_gain);
  EXPECT_EQ(error_after([](auto& p) { p.Kc[1] = std::numeric_limits<float>::infinity(); }), Refusal::state_feedback);
  EXPECT_EQ(error_after([](auto& p) {
              p.friction_feedforward_on = true;
              p.friction.negative.static_V = -1.0f;
            }),
            Refusal::friction_curve);
  EXPECT_EQ(error_after([](auto& p) {
              p.friction_feedforward_on = true;
              p.friction.blend_velocity_rad_s = 0.0f;
            }),
            Refusal::friction_blend);
  EXPECT_EQ(error_after([](auto& p) { p.velocity_limit = 0.0f; }), Refusal::velocity_limit);
  EXPECT_EQ(error_after([](auto& p) { p.velocity_limit = 1e6f; }), Refusal::velocity_limit);
  EXPECT_EQ(error_after([](auto& p) { p.acceleration_limit = 0.0f; }), Refusal::acceleration_limit);
  EXPECT_EQ(error_after([](auto& p) { p.jerk_limit = 0.0f; }), Refusal::jerk_limit);
  EXPECT_EQ(error_after([](auto& p) { p.jerk_limit = 1e-3f; }), Refusal::jerk_time);
}

TEST(AxisParameterCheck, AnUnconfiguredAxisCannotBeEnabled) {
  const auto p = parameters_of<float>(kPaperX);
  LinearAxis drive(p);
  Axis<float, LinearAxis> axis(drive);
  EXPECT_FALSE(axis.enable());
  EXPECT_EQ(axis.telemetry().fault, AxisFault::parameters_missing);
}

}  // namespace
