// Properties that hold for every drive of a family, whatever its values.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "tests/sim/small_drive.hpp"

namespace {

using sim::Drive;
using sim::DriveState;
using sim_test::coulomb_drive;
using sim_test::free_mass;
using sim_test::kLead;
using sim_test::with;

/// A number between two bounds, in steps of a thousandth of the range.
rc::Gen<double> between(double low, double high) {
  return rc::gen::map(rc::gen::inRange(0, 1001), [=](int k) { return low + (high - low) * k / 1000.0; });
}

/// A drive whose friction is drawn from the whole catalogue of dissipative effects.
sim::DriveDescription any_passive_drive() {
  sim::DriveDescription drive = free_mass();
  drive.effects.front().parameters["J"] = *between(1e-3, 0.1);
  drive = with(drive, "viscous", {{"B", *between(0.0, 0.1)}});
  const double level = *between(0.0, 2.0), omega = *between(0.0, 6.0);
  drive = with(drive, "coulomb", {{"level", level}});
  if (*rc::gen::arbitrary<bool>())
    drive = with(drive, "stribeck", {{"static", level * *between(1.0, 2.0)}, {"omega1", omega}, {"omega2", omega}});
  if (*rc::gen::arbitrary<bool>())
    drive = with(drive, "nonlinear_viscous", {{"coefficient", *between(0.0, 0.5)}, {"exponent", *between(0.3, 2.5)}});
  if (*rc::gen::arbitrary<bool>()) drive = with(drive, "friction_lag", {{"time", *between(0.001, 0.1)}});
  if (*rc::gen::arbitrary<bool>())
    drive = with(drive, "dwell_stiction", {{"gain", *between(0.0, 1.0)}, {"time_constant", *between(0.1, 5.0)}});
  if (*rc::gen::arbitrary<bool>())
    drive = with(drive, "position_dependent_friction",
                 {{"cosine", *between(-0.6, 0.6)}, {"sine", *between(-0.6, 0.6)}, {"period", *between(5.0, 500.0)}});
  if (*rc::gen::arbitrary<bool>())
    drive = with(drive, "load_dependent_friction", {{"coefficient", *between(0.0, 0.4)}});
  return drive;
}

RC_GTEST_PROP(PassiveDrive, NeverGainsSpeedWithoutACommand, ()) {
  const Drive drive(any_passive_drive());
  const double period_s = *between(0.0002, 0.005);
  DriveState state = drive.at(*between(-100.0, 100.0), *between(-50.0, 50.0));
  for (int k = 0; k < 300; ++k) {
    const double before = state.w;
    drive.step(state, 0.0, period_s * k, period_s);
    RC_ASSERT(std::abs(state.w) <= std::abs(before));
    RC_ASSERT(state.w * before >= 0.0);
  }
}

RC_GTEST_PROP(PassiveDrive, TakesNoMoreEnergyThanTheCommandGives, ()) {
  const Drive drive(any_passive_drive());
  DriveState state = drive.at(0.0, 0.0);
  const double inertia = drive.inertia;
  double work = 0.0;
  for (int k = 0; k < 300; ++k) {
    const double u_V = k % 50 == 0 ? *between(-5.0, 5.0) : 0.0;
    const double before_x = state.x;
    for (int held = 0; held < 10; ++held) drive.step(state, u_V, 0.001 * k, 0.0001);
    work += u_V * (state.x - before_x) / kLead;
    RC_ASSERT(0.5 * inertia * state.w * state.w <= work + 1e-9 * (1.0 + std::abs(work)));
  }
}

RC_GTEST_PROP(SymmetricDrive, AnswersAMirroredCommandWithTheMirroredMotion, ()) {
  sim::DriveDescription description = any_passive_drive();
  std::erase_if(description.effects,
                [](const sim::EffectEntry& effect) { return effect.kind == "position_dependent_friction"; });
  if (*rc::gen::arbitrary<bool>()) description = with(description, "current_loop_lag", {{"bandwidth", 80.0}});
  if (*rc::gen::arbitrary<bool>()) description = with(description, "input_delay", {{"delay", 0.0017}});
  if (*rc::gen::arbitrary<bool>()) description = with(description, "current_saturation", {{"limit", 5.0}});
  if (*rc::gen::arbitrary<bool>()) description = with(description, "dac_dead_zone", {{"width", 0.1}});
  if (*rc::gen::arbitrary<bool>())
    description = with(description, "voltage_limit", {{"stall", 3.0}, {"no_load_speed", 30.0}});
  switch (*rc::gen::inRange(0, 3)) {
    case 0:
      description = with(description, "presliding", {{"sigma0", 500.0}, {"sigma1", 1.0}});
      break;
    case 1:
      description = with(description, "backlash",
                         {{"gap", 0.1}, {"resonance", 60.0}, {"damping_ratio", 0.1}, {"load_fraction", 0.4}});
      break;
    default:
      break;
  }
  const Drive drive(description);
  DriveState state = drive.at(0.0, 3.0), mirrored = drive.at(0.0, -3.0);
  for (int k = 0; k < 200; ++k) {
    const double u_V = *between(-4.0, 4.0);
    drive.step(state, u_V, 0.001 * k, 0.001);
    drive.step(mirrored, -u_V, 0.001 * k, 0.001);
    RC_ASSERT(state.w == -mirrored.w);
    RC_ASSERT(state.x == -mirrored.x);
    RC_ASSERT(std::isfinite(state.x));
  }
}

RC_GTEST_PROP(Drive, StepsComposeWhereTheMotionIsExact, ()) {
  const Drive drive(coulomb_drive());
  DriveState whole = drive.at(0.0, *between(-20.0, 20.0)), parts = whole;
  const double u_V = *between(-3.0, 3.0), first_s = *between(0.0, 0.2), second_s = *between(0.0, 0.2);
  drive.step(whole, u_V, 0.0, first_s + second_s);
  drive.step(parts, u_V, 0.0, first_s);
  drive.step(parts, u_V, first_s, second_s);
  RC_ASSERT(std::abs(whole.w - parts.w) <= 1e-8);
  RC_ASSERT(std::abs(whole.x - parts.x) <= 1e-8);
}

}  // namespace
