#include "host/identify/inverse_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace {

sim::DriveDescription motor_with_ripple(double order, double amplitude_Nm) {
  sim::DriveDescription model;
  model.data.kind = sim::DriveKind::rotary;
  model.data.amplifier_gain_A_per_V = 1.0;
  model.data.torque_constant_Nm_per_A = 1.0;
  model.data.lead = 1.0;  // 1 mm stands for 1 rad
  model.data.dac_limit_V = 100.0;
  model.data.encoder_resolution = 1e-6;
  model.effects = {
      {"inertia", {{"J", 0.01}}, {}, {}},
      {"viscous", {{"B", 0.02}}, {}, {}},
      {"coulomb", {{"level", 1.0}}, {}, {}},
      {"cogging", {{"period", 2.0 * std::numbers::pi / order}, {"cosine", amplitude_Nm}, {"sine", 0.0}}, {}, {}}};
  return model;
}

/// A speed that varies around 10 rad/s, and the torque that a motor with this ripple needs for it, computed by hand.
host::Record turning(double order, double amplitude_Nm) {
  host::Record record;
  record.path = "turning.csv";
  record.sample_period_s = 0.001;
  for (int k = 0; k < 4000; ++k) {
    const double t = 0.001 * k;
    const double x = 10.0 * t - 1.0 * std::cos(2.0 * t), w = 10.0 + 2.0 * std::sin(2.0 * t),
                 a = 4.0 * std::cos(2.0 * t);
    record.t_s.push_back(t);
    record.x.push_back(x);
    record.i_A.push_back(0.01 * a + 0.02 * w + 1.0 - amplitude_Nm * std::cos(order * x));
  }
  return record;
}

TEST(InverseModel, ARippleBeyondTheFilterIsFilteredAsTheMeasuredTorqueIs) {
  // 72 orders at 10 rad/s are 115 Hz. The torque is filtered below 30 Hz, so nothing of them remains.
  const sim::DriveDescription model = motor_with_ripple(72.0, 0.5);
  const host::Record record = turning(72.0, 0.5);
  host::MotionOptions options;
  options.cutoff_Hz = 30.0;
  EXPECT_LT(host::relative_error(model, record, options), 0.01);
}

TEST(InverseModel, ASlowRippleCounts) {
  const host::Record record = turning(1.0, 0.5);
  EXPECT_LT(host::relative_error(motor_with_ripple(1.0, 0.5), record), 0.01);
  EXPECT_NEAR(host::relative_error(motor_with_ripple(1.0, 0.0), record), 0.5 / std::sqrt(2.0) / 1.25, 0.05);
}

/// Catches a dead band that removes all samples of a slow axis: half a degree per second, and a hundredth of that.
TEST(InverseModel, ASlowAxisHasAnErrorToo) {
  // The ripple, which the model has and the drive has not: mean square of its cosine over 0 to 1.2 rad and 0 to 0.12
  // rad.
  for (const auto& [slow, ripple] : {std::pair(0.03, 0.40), {0.003, 0.50}}) {
    host::Record record = turning(1.0, 0.0);
    for (std::size_t k = 0; k < record.size(); ++k) {
      const double t = record.t_s[k], w = slow * (10.0 + 2.0 * std::sin(2.0 * t)), a = slow * 4.0 * std::cos(2.0 * t);
      record.x[k] = slow * (10.0 * t - std::cos(2.0 * t));
      record.i_A[k] = 0.01 * a + 0.02 * w + 1.0;
    }
    EXPECT_LT(host::relative_error(motor_with_ripple(1.0, 0.0), record), 0.01);
    EXPECT_NEAR(host::relative_error(motor_with_ripple(1.0, 0.5), record), ripple, 0.02);
  }
}

}  // namespace
