// The encoder compared with the motion expected from the command, on drives that respond and drives that do not.
#include "firmware/core/supervision/effort_monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "tests/firmware/paper_axes.hpp"

namespace {

using firmware::AxisFault;
using firmware_test::kPaperX;

constexpr float kVelocityPerCount =
    static_cast<float>(firmware_test::kEncoderResolution_mm / firmware_test::kLead_mm_per_rad / 0.001);

/// A drive with dry friction and an encoder, commanded in volts; fault of the monitor, and its time.
class CommandedDrive {
 public:
  double friction_V = 1.5;
  double inertia = 1.0;  ///< of the model's
  double sense = 1.0;    ///< -1: it runs against its command
  double load_V = 0.0;   ///< a constant one
  bool encoder_lives = true;
  double velocity_rad_s = 0.0;
  int noise_counts = 0;

  CommandedDrive() { monitor_.configure(firmware_test::parameters_of<float>(kPaperX)); }

  /// The first fault, and the sample of it in `sample`.
  AxisFault run(int samples, const std::function<double(int)>& command_V) {
    for (int k = 0; k < samples; ++k) {
      const double u = command_V(k);
      seen_.output_V = static_cast<float>(u);
      seen_.feedback_V = 0.0f;
      const AxisFault fault = monitor_.watch(seen_, read_velocity());
      advance(u);
      sample = k;
      if (fault != AxisFault::none) return fault;
    }
    return AxisFault::none;
  }
  int sample = 0;

 private:
  void advance(double u) {
    const double net = sense * u - load_V;
    const double push = velocity_rad_s != 0.0        ? net - std::copysign(friction_V, velocity_rad_s)
                        : std::abs(net) > friction_V ? net - std::copysign(friction_V, net)
                                                     : 0.0;
    const double next = velocity_rad_s + kPaperX.Bd2 / inertia * push;
    velocity_rad_s = velocity_rad_s * next < 0.0 ? 0.0 : next;
    counts_ += velocity_rad_s / static_cast<double>(kVelocityPerCount);
  }

  float read_velocity() {
    double reading = encoder_lives ? std::floor(counts_) : 0.0;
    if (noise_counts != 0) reading += std::uniform_int_distribution<int>(-noise_counts, noise_counts)(noise_);
    const double travel = reading - last_counts_;
    last_counts_ = reading;
    return static_cast<float>(travel) * kVelocityPerCount;
  }

  firmware::EffortMonitor<float> monitor_;
  firmware::AxisTelemetry<float> seen_;
  std::mt19937 noise_{7};
  double counts_ = 0.0, last_counts_ = 0.0;
};

double full_reversals(int k) { return k / 50 % 2 == 0 ? 10.0 : -10.0; }

TEST(EffortMonitor, IsSilentWhileASoundDriveIsDrivenAsHardAsItCan) {
  CommandedDrive drive;
  drive.noise_counts = 1;
  EXPECT_EQ(drive.run(5000, full_reversals), AxisFault::none);
}

TEST(EffortMonitor, BearsTwiceTheModelsInertia) {
  CommandedDrive drive;
  drive.inertia = 1.9;
  drive.friction_V = 2.5;
  EXPECT_EQ(drive.run(5000, full_reversals), AxisFault::none);
}

TEST(EffortMonitor, ADeadEncoderIsFoundInTenSamplesOfFullCommand) {
  CommandedDrive drive;
  drive.encoder_lives = false;
  EXPECT_EQ(drive.run(100, [](int) { return 10.0; }), AxisFault::command_without_motion);
  EXPECT_LE(drive.sample, 10);
}

TEST(EffortMonitor, ACommandBelowTheThresholdPromisesNothing) {
  CommandedDrive drive;
  drive.friction_V = 4.0;
  EXPECT_EQ(drive.run(20'000, [](int) { return 2.95; }), AxisFault::none);
}

TEST(EffortMonitor, WhatHoldsALoadIsNoLackOfMotion) {
  CommandedDrive drive;
  drive.load_V = 6.0;  // a vertical axis, whose command came up with its load
  EXPECT_EQ(drive.run(20'000, [](int k) { return 6.0 * (1.0 - std::exp(-k / 2000.0)); }), AxisFault::none);
}

TEST(EffortMonitor, ADriveThatRunsAgainstItsCommandIsReversed) {
  CommandedDrive drive;
  drive.sense = -1.0;
  EXPECT_EQ(drive.run(100, [](int) { return 6.0; }), AxisFault::feedback_polarity);
  EXPECT_LE(drive.sample, 12);
}

TEST(EffortMonitor, OneBadReadingIsNotEnough) {
  CommandedDrive drive;
  EXPECT_EQ(drive.run(20, [](int) { return 6.0; }), AxisFault::none);
  drive.noise_counts = 20;
  EXPECT_EQ(drive.run(2, [](int) { return 6.0; }), AxisFault::none);
  drive.noise_counts = 0;
  EXPECT_EQ(drive.run(100, [](int) { return 6.0; }), AxisFault::none);
}

/// The monitor's result for a feedback command.
AxisFault watch_feedback(int samples, const std::function<double(int)>& feedback_V, int* at = nullptr) {
  firmware::EffortMonitor<float> monitor;
  monitor.configure(firmware_test::parameters_of<float>(kPaperX));
  firmware::AxisTelemetry<float> seen;
  for (int k = 0; k < samples; ++k) {
    seen.feedback_V = static_cast<float>(feedback_V(k));
    if (at != nullptr) *at = k;
    if (const AxisFault fault = monitor.watch(seen, 0.0f); fault != AxisFault::none) return fault;
  }
  return AxisFault::none;
}

TEST(SwingMonitor, FindsAnUnstableLoopThatNeverSaturatesForLong) {
  int at = 0;
  EXPECT_EQ(watch_feedback(
                1000, [](int k) { return k % 2 == 0 ? 8.3 : -8.3; }, &at),
            AxisFault::limit_cycle);
  EXPECT_LE(at, 50);
  EXPECT_EQ(watch_feedback(1000, [](int k) { return 5.0 * std::sin(0.25 * k); }), AxisFault::limit_cycle) << "40 Hz";
}

/// Removing the slow part increases the fastest oscillation by a sixteenth: 2.5 V / (1 + 1/16) = 2.35 V.
TEST(SwingMonitor, TripsAtItsThreshold) {
  const auto swing = [](double rms) { return [rms](int k) { return k % 2 == 0 ? rms : -rms; }; };
  EXPECT_EQ(watch_feedback(5000, swing(2.3)), AxisFault::none);
  EXPECT_EQ(watch_feedback(5000, swing(2.4)), AxisFault::limit_cycle);
}

TEST(SwingMonitor, BearsWhatLoadsAndReversalsAsk) {
  EXPECT_EQ(watch_feedback(5000, [](int) { return 9.0; }), AxisFault::none) << "a sudden constant load";
  EXPECT_EQ(watch_feedback(5000, [](int k) { return k / 100 % 2 == 0 ? 2.0 : -2.0; }), AxisFault::none) << "friction";
}

}  // namespace
