// The limits of an axis's references from design, on the plants in closed loop: the firmware's command stays within the
// stated reserve. Catches a missing load, friction or limit of the amplifier, and values of the wrong direction.
#include "host/parameters/drive_limits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "host/exit_codes.hpp"
#include "host/hil/commissioning.hpp"
#include "host/hil/contouring.hpp"
#include "host/identify/paper_drives.hpp"

namespace {

using host::DriveLimits;
using host::LimitWishes;

sim::EffectEntry effect(const char* kind, std::map<std::string, double> parameters) {
  return {.kind = kind, .parameters = std::move(parameters), .ci95 = {}, .from = {}};
}

sim::DriveDescription paper_x(std::vector<sim::EffectEntry> more = {}) {
  sim::DriveDescription drive = *host::paper_drive("x");
  drive.effects.insert(drive.effects.end(), more.begin(), more.end());
  return drive;
}

LimitWishes all_of(double reserve) {
  LimitWishes wishes;
  wishes.reserve = reserve;
  wishes.as_the_drive_allows = true;
  return wishes;
}

struct Ride {
  double most_V = 0.0, worst_um = 0.0;
};

/// A line along x with the given limits, forth or back, followed by the firmware on the plant.
Ride ride(const sim::DriveDescription& drive, const host::ReferenceLimits& limits, double length_mm) {
  std::array<host::MachineAxis, 2> axes;
  for (std::size_t i = 0; i < 2; ++i) {
    axes[i].drive = i == 0 ? drive : paper_x();
    axes[i].parameters = host::contouring_parameters(axes[i].drive, {.friction = true, .cancellation = true}, limits);
  }
  const auto run = host::run_contour(axes, host::Path::line({length_mm, 0.0}),
                                     {limits.velocity, limits.acceleration, limits.jerk}, 5);
  Ride found;
  // Means over 10 ms remove the command's noise; an acceleration lasts longer.
  const std::vector<double>& u = run.records[0].u_V;
  constexpr std::size_t kMean = 10;
  for (std::size_t k = kMean; k <= u.size(); ++k)
    found.most_V = std::max(found.most_V, std::abs(std::accumulate(&u[k - kMean], &u[k - 1] + 1, 0.0)) / kMean);
  found.worst_um = run.worst_tracking_um(0);
  return found;
}

Ride both_ways(const sim::DriveDescription& drive, const host::ReferenceLimits& limits) {
  const Ride there = ride(drive, limits, 150.0), back = ride(drive, limits, -150.0);
  return {std::max(there.most_V, back.most_V), std::max(there.worst_um, back.worst_um)};
}

struct Case {
  const char* name;
  std::vector<sim::EffectEntry> more;
  double reserve;
  double (*limit_V)(double speed_rad_s);  ///< by the data of the test
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

class OnThePlant : public testing::TestWithParam<Case> {};

TEST_P(OnThePlant, TheCommandStaysWithinTheReserve) {
  const Case& one = GetParam();
  const sim::DriveDescription drive = paper_x(one.more);
  const DriveLimits limits = host::drive_limits(drive, all_of(one.reserve));
  const Ride done = both_ways(drive, limits.written);
  std::printf("%s: %.0f mm/s, %.0f mm/s^2, %.0f mm/s^3 (%s): stated %.3f V of %.3f V, needed %.3f V\n", one.name,
              limits.written.velocity, limits.written.acceleration, limits.written.jerk, limits.acceleration.by.c_str(),
              limits.command_V, limits.limit_V, done.most_V);
  const double limit_V = one.limit_V(limits.written.velocity / (10.0 / (2.0 * std::numbers::pi)));
  EXPECT_NEAR(limits.limit_V, limit_V, 0.02 * limit_V);
  EXPECT_NEAR(limits.command_V, (1.0 - one.reserve) * limit_V, 0.03 * limit_V);
  // The stated command is the sum of all worst cases: a motion need not have its full acceleration at top speed.
  EXPECT_LE(done.most_V, 1.02 * limits.command_V);
  EXPECT_GE(done.most_V, 0.85 * limits.command_V);
  EXPECT_LT(done.worst_um, 40.0);
}

constexpr double kGain = 6.4898 * 0.4769;  // Nm/V, Table 1
double converter(double) { return 10.0; }

INSTANTIATE_TEST_SUITE_P(
    Drives, OnThePlant,
    testing::Values(
        Case{"converter", {}, 0.3, converter}, Case{"half", {}, 0.5, converter},
        Case{"current", {effect("current_saturation", {{"limit", 20.0}})}, 0.3, [](double) { return 20.0 / 6.4898; }},
        Case{"weight", {effect("constant_torque", {{"torque", -1.5}})}, 0.3, converter},
        Case{"weight_current",
             {effect("constant_torque", {{"torque", 1.2}}), effect("current_saturation", {{"limit", 30.0}})},
             0.2,
             [](double) { return 30.0 / 6.4898; }},
        Case{"cogging", {effect("cogging", {{"cosine", 1.5}, {"sine", -0.8}, {"period", 2.5}})}, 0.3, converter},
        Case{"voltage",
             {effect("voltage_limit", {{"stall", 25.0}, {"no_load_speed", 600.0}})},
             0.3,
             [](double speed) { return 25.0 * (1.0 - speed / 600.0) / kGain; }}),
    [](const auto& which) { return which.param.name; });

/// Above the limits the amplifier saturates, and the axis falls behind.
TEST(DriveLimits, BeyondTheDriveTheAxisFallsBehind) {
  const sim::DriveDescription drive = paper_x({effect("current_saturation", {{"limit", 20.0}})});
  const DriveLimits limits = host::drive_limits(drive, all_of(0.2));
  host::ReferenceLimits beyond = limits.written;
  beyond.acceleration *= 4.0;
  beyond.jerk *= 4.0;
  const double within_um = both_ways(drive, limits.written).worst_um;
  const double beyond_um = [&] {
    try {
      return both_ways(drive, beyond).worst_um;
    } catch (const host::Failure&) {
      return 1e9;  // a monitor ended the motion
    }
  }();
  std::printf("within %.1f um, beyond %.1f um\n", within_um, beyond_um);
  EXPECT_GT(beyond_um, 10.0 * within_um);
}

TEST(DriveLimits, UsualLimitsAreLoweredOnlyWhereTheDriveNeedsIt) {
  const DriveLimits strong = host::drive_limits(paper_x(), {});
  EXPECT_EQ(strong.written.velocity, 250.0);
  EXPECT_EQ(strong.written.acceleration, 2000.0);
  EXPECT_EQ(strong.written.jerk, 50'000.0);
  EXPECT_LT(strong.command_V, 0.7 * strong.limit_V);
  const DriveLimits weak = host::drive_limits(paper_x({effect("current_saturation", {{"limit", 15.0}})}), {});
  EXPECT_LT(weak.written.acceleration, 2000.0);
  EXPECT_NEAR(weak.command_V, 0.7 * weak.limit_V, 0.01 * weak.limit_V);
}

/// At the top speed half of the acceleration is left, by the drive's equations written out.
TEST(DriveLimits, AVoltageLimitLowersTheTopSpeed) {
  const DriveLimits limits =
      host::drive_limits(paper_x({effect("voltage_limit", {{"stall", 20.0}, {"no_load_speed", 150.0}})}), {});
  EXPECT_EQ(limits.velocity.by, "the voltage limit");
  const double w = limits.velocity.value / (10.0 / (2.0 * std::numbers::pi));
  const auto room = [](double speed) {
    const double friction = 3.647 * std::exp(-speed / 2.0) + 2.205 * (1.0 - std::exp(-speed / 2.0)) + 0.0321 * speed;
    return 0.7 * 20.0 * (1.0 - speed / 150.0) - friction;
  };
  EXPECT_NEAR(room(w), 0.5 * room(0.0), 0.02 * room(0.0));
  EXPECT_LT(limits.written.velocity, 250.0);
}

/// A ramp of the acceleration excites an undamped mode of frequency f to at most 0.22 of its static deflection (mode
/// equation, integrated); with ten times the jerk, to nearly twice the static deflection.
TEST(DriveLimits, TheJerkSparesTheResonance) {
  const double resonance_Hz = 14.0;
  const auto spring =
      effect("compliance", {{"resonance", resonance_Hz}, {"damping_ratio", 0.02}, {"load_fraction", 0.4}});
  const DriveLimits limits = host::drive_limits(paper_x({spring}), all_of(0.3));
  EXPECT_NE(limits.jerk.by.find("14"), std::string::npos) << limits.jerk.by;
  const auto left = [&](double f_Hz, double jerk) {
    const double omega = 2.0 * std::numbers::pi * f_Hz, a = limits.written.acceleration, ramp_s = a / jerk, dt = 1e-6;
    double z = 0.0, dz = 0.0;  // deflection, in units of a / omega^2
    for (double t = 0.0; t < ramp_s; t += dt) {
      dz += dt * omega * omega * (t / ramp_s - z);
      z += dt * dz;
    }
    return std::hypot(z - 1.0, dz / omega);
  };
  for (const double f_Hz : {14.0, 17.0, 21.0, 28.0, 50.0, 90.0})
    EXPECT_LT(left(f_Hz, limits.written.jerk), 0.22) << f_Hz;
  EXPECT_GT(left(resonance_Hz, 10.0 * limits.written.jerk), 0.9);
}

TEST(DriveLimits, ACountedTopSpeedAndWhatIsNotCounted) {
  LimitWishes wishes = all_of(0.3);
  wishes.top_speed_mm_s = 400.0;
  const DriveLimits limits =
      host::drive_limits(paper_x({effect("spring_torque", {{"stiffness", 0.01}, {"centre", 0.0}})}), wishes);
  EXPECT_EQ(limits.written.velocity, 400.0);
  ASSERT_EQ(limits.not_counted.size(), 1u);
  EXPECT_EQ(limits.not_counted.front(), "spring_torque");
}

TEST(DriveLimits, ALinearAxisHasItsOwnInMetres) {
  sim::DriveDescription linear;
  linear.name = "z";
  linear.data.kind = sim::DriveKind::linear;
  linear.data.force_constant_N_per_V = 60.0;
  linear.effects = {effect("inertia", {{"J", 20.0}}), effect("viscous", {{"B", 60.0}}),
                    effect("coulomb", {{"positive", 30.0}, {"negative", -30.0}})};
  LimitWishes wishes = all_of(0.25);
  wishes.top_speed_mm_s = 500.0;
  const DriveLimits limits = host::drive_limits(linear, wishes);
  EXPECT_NEAR(limits.written.velocity, 0.5, 1e-12);
  EXPECT_NEAR(limits.written.acceleration, (0.75 * 600.0 - 30.0 - 30.0) / 20.0, 1e-6);
  EXPECT_NEAR(limits.written.jerk, 30.0 * limits.written.acceleration, 1e-6);
}

TEST(DriveLimits, FrictionThatLeavesNothingIsRefused) {
  const auto weak = paper_x({effect("current_saturation", {{"limit", 8.0}})});  // 3.8 Nm, 3.65 Nm of static friction
  try {
    host::drive_limits(weak, {});
    FAIL() << "not refused";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::refused);
  }
}

}  // namespace
