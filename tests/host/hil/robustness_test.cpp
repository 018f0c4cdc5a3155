// Contour errors of machines that differ from their models. Truth: the frequency response of the loop with the changed
// drive, without friction and noise; and the order of controllers in the paper. Catches a change that also reaches the
// controller, a change with the wrong sign, and a controller without its switch.
#include "host/hil/robustness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/axes/contour_forecast.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/paper_drives.hpp"

namespace {

enum Controller : std::size_t { kFeedback, kZeroPhase, kFriction, kCancellation };

const host::RobustnessPoint& at(const host::Robustness& found, const std::string& quantity, double change) {
  for (const host::RobustnessCurve& curve : found.curves)
    for (const host::RobustnessPoint& point : curve.points)
      if (curve.quantity == quantity && point.change == change) return point;
  throw std::out_of_range(quantity);
}

double rms(const host::Robustness& found, const std::string& quantity, double change, Controller controller) {
  return at(found, quantity, change).by_controller.at(controller).rms_um;
}

/// Only viscous friction, fine encoders, low-noise tachometers.
sim::DriveDescription quiet(const char* axis) {
  sim::DriveDescription drive = *host::paper_drive(axis);
  drive.data.encoder_resolution = 1e-4;
  drive.data.tach_noise_variance = 1e-8;
  std::erase_if(drive.effects,
                [](const sim::EffectEntry& one) { return one.kind == "coulomb" || one.kind == "stribeck"; });
  return drive;
}

/// Radius error of a circle of 35 mm at 170 mm/s, by the loop's frequency response: mean of both axes.
double radius_error_um(const host::RobustnessMachine& machine, double inertia, double delay_s, bool zero_phase) {
  const double f_Hz = 170.0 / (2.0 * std::numbers::pi * 35.0);
  double sum = 0.0;
  for (const host::RobustnessAxis& axis : machine) {
    sim::DriveDescription changed = axis.drive;
    changed.find("inertia")->parameters["J"] *= inertia;
    if (delay_s > 0.0)
      changed.effects.push_back({.kind = "input_delay", .parameters = {{"delay", delay_s}}, .ci95 = {}, .from = {}});
    firmware::AxisParameters<float> parameters = axis.parameters;
    parameters.zero_phase_feedforward_on = zero_phase;
    parameters.disturbance_cancellation_on = false;
    sum += std::abs(host::following({host::plant_of(changed), host::AxisController(parameters)}, f_Hz)) - 1.0;
  }
  return std::abs(1e3 * 35.0 * sum / 2.0);
}

TEST(Robustness, WithoutFrictionTheErrorIsThatOfTheFrequencyResponse) {
  const host::RobustnessMachine machine = {host::robustness_axis(quiet("x"), ""),
                                           host::robustness_axis(quiet("y"), "")};
  const host::Robustness found = host::find_robustness(machine, {});
  struct Case {
    const char* quantity;
    double change, inertia, delay_s;
  };
  for (const Case& one : {Case{"inertia", -20.0, 0.8, 0.0}, Case{"inertia", 20.0, 1.2, 0.0},
                          Case{"inertia", 0.0, 1.0, 0.0}, Case{"delay", 1.0, 1.0, 0.001}})
    for (const bool zero_phase : {false, true}) {
      const double expected = radius_error_um(machine, one.inertia, one.delay_s, zero_phase);
      const double seen = rms(found, one.quantity, one.change, zero_phase ? kZeroPhase : kFeedback);
      std::printf("%s %+g, %s: response %.2f um, simulated %.2f um RMS\n", one.quantity, one.change,
                  zero_phase ? "ZPETC" : "feedback", expected, seen);
      // Start and end take an eighth of the circle's time.
      EXPECT_NEAR(seen, expected, 0.15 * expected + 0.3);
    }
}

TEST(Robustness, FeedForwardDependsOnTheModelAndFeedbackDoesNot) {
  const host::RobustnessMachine machine = {host::robustness_axis(*host::paper_drive("x"), ""),
                                           host::robustness_axis(*host::paper_drive("y"), "")};
  const host::Robustness found = host::find_robustness(machine, {});
  // The paper's order, p. 1507: friction feed-forward removes most of the error if friction is as modelled.
  EXPECT_LT(rms(found, "friction", 0.0, kFriction), 0.4 * rms(found, "friction", 0.0, kZeroPhase));
  // It performs worse if friction differs.
  EXPECT_GT(rms(found, "friction", 30.0, kFriction), 2.0 * rms(found, "friction", 0.0, kFriction));
  EXPECT_GT(rms(found, "friction", -30.0, kFriction), 2.0 * rms(found, "friction", 0.0, kFriction));
  // Cancellation removes most of the error due to wrong friction.
  EXPECT_LT(rms(found, "friction", 30.0, kCancellation), 0.6 * rms(found, "friction", 30.0, kFriction));
  for (const host::RobustnessCurve& curve : found.curves)
    for (const host::RobustnessPoint& point : curve.points)
      for (const host::ContourFigures& one : point.by_controller) EXPECT_EQ(one.fault, "") << curve.quantity;
}

TEST(Robustness, OneAxisAloneMayDiffer) {
  const host::RobustnessMachine machine = {host::robustness_axis(quiet("x"), ""),
                                           host::robustness_axis(quiet("y"), "")};
  host::RobustnessOptions options;
  options.differs = {true, false};
  const double one = rms(host::find_robustness(machine, options), "inertia", 20.0, kZeroPhase);
  const double both = rms(host::find_robustness(machine, {}), "inertia", 20.0, kZeroPhase);
  EXPECT_LT(one, both);
  EXPECT_GT(one, 0.2 * both);
}

TEST(Robustness, RefusesDrivesThatItCannotSimulate) {
  sim::DriveDescription linear;
  linear.data.kind = sim::DriveKind::linear;
  linear.data.force_constant_N_per_V = 35.0;
  EXPECT_THROW(host::robustness_axis(linear, ""), host::Failure);
  sim::DriveDescription ideal = quiet("x");
  ideal.data.encoder_resolution = 0.0;
  EXPECT_THROW(host::robustness_axis(ideal, ""), host::Failure);
}

}  // namespace
