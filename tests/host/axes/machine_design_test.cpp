// Two drives that differ by a factor of two in inertia, friction and possible bandwidth: lines and circles of the
// firmware's axes on the plants, with each axis's best loop and with one loop for both.
#include "host/axes/machine_design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hal/pc/simulated_axis.hpp"
#include "host/exit_codes.hpp"
#include "host/hil/contouring.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "tests/host/axes/unlike_axes.hpp"

namespace {

using axes_test::designed;
using axes_test::drive;
using axes_test::effect;
using axes_test::kCount_um;
using axes_test::machine;
using axes_test::Tasks;
using host::Path;

constexpr std::uint64_t kSeed = 11;

/// The same with encoders of 0.1 um, low-noise tachometers and viscous friction only.
const Tasks& quiet_machine() {
  static const Tasks tasks = [] {
    Tasks quiet = machine();
    for (host::AxisTask& task : quiet) {
      task.model.data.encoder_resolution = 1e-4;
      task.model.data.tach_noise_variance = 1e-6;
      std::erase_if(task.model.effects,
                    [](const sim::EffectEntry& one) { return one.kind == "coulomb" || one.kind == "stribeck"; });
    }
    return quiet;
  }();
  return tasks;
}

std::array<host::MachineAxis, 2> axes_of(const Tasks& tasks, const host::LoopSet& set) {
  std::array<host::MachineAxis, 2> axes;
  for (std::size_t i = 0; i < 2; ++i) {
    const host::AxisLoop& loop = set.axes[i];
    axes[i].drive = tasks[i].model;
    axes[i].parameters = host::axis_parameters(loop.model, loop.design, hal::pc::AxisWiring{}.tachometer_resolution);
    axes[i].parameters.filters = host::core_filters(loop.filters, 1e-3);
    axes[i].parameters.zero_phase_feedforward_on = loop.design.used.zero_phase;
    axes[i].parameters.friction_feedforward_on = true;
    axes[i].parameters.disturbance_cancellation_on = true;
  }
  return axes;
}

/// Largest distance of the encoder positions from a line of 90 mm. Ignores its first and last `ends_mm`, where the axes
/// break away and stop and friction dominates.
double line_error_um(const Tasks& tasks, const host::LoopSet& set, double angle_deg, double feed, bool back,
                     double ends_mm = 1.0) {
  const double angle = angle_deg * std::numbers::pi / 180.0 + (back ? std::numbers::pi : 0.0), length = 90.0;
  const double c = std::cos(angle), s = std::sin(angle);
  const auto run =
      host::run_contour(axes_of(tasks, set), Path::line({length * c, length * s}), {feed, 2000.0, 50'000.0}, kSeed);
  double most = 0.0;
  for (std::size_t k = 0; k < run.t_s.size(); ++k) {
    const double along = c * run.records[0].x_ref[k] + s * run.records[1].x_ref[k];
    if (along > ends_mm && along < length - ends_mm)
      most = std::max(most, std::abs(c * run.tracking_um[1][k] - s * run.tracking_um[0][k]));
  }
  return most;
}

/// Difference of the half axes of the ellipse fitted to the encoder positions of two turns, after the first quarter.
double ellipse_um(const host::LoopSet& set, double feed, int turns) {
  const double radius = 35.0;
  const auto run =
      host::run_contour(axes_of(machine(), set), Path::circle(radius, turns), {feed, 2000.0, 50'000.0}, kSeed);
  axes_test::EllipseFit fit(radius);
  for (std::size_t k = 0; k < run.t_s.size(); ++k) {
    if (run.t_s[k] < run.begin_s + 0.3 || run.t_s[k] > run.end_s - 0.3) continue;
    fit.add(run.records[0].x[k] + kCount_um / 2e3 - radius, run.records[1].x[k] + kCount_um / 2e3);
  }
  return fit.um();
}

class Machine : public testing::TestWithParam<bool> {};

TEST_P(Machine, OneLoopKeepsLinesStraight) {
  const host::MachineDesign design = designed(machine(), GetParam());
  for (const double feed : {50.0, 100.0, 200.0})
    for (const double angle : {15.0, 45.0, 75.0})
      for (const bool back : {false, true}) {
        const double before = line_error_um(machine(), design.own, angle, feed, back);
        const double after = line_error_um(machine(), design.matched, angle, feed, back);
        std::printf("%s, %3.0f mm/s, %2.0f degrees%s: own %6.2f um, matched %5.2f um\n",
                    GetParam() ? "zero phase" : "velocity", feed, angle, back ? " back" : "", before, after);
        if (!GetParam() && angle == 45.0) {
          EXPECT_LE(after, before / 5.0) << feed;
        }
        EXPECT_LE(after, before + kCount_um / 2.0) << feed << ' ' << angle;
      }
}

TEST_P(Machine, OneLoopKeepsCirclesRound) {
  const host::MachineDesign design = designed(machine(), GetParam());
  for (const double feed : {50.0, 170.0})
    for (const int turns : {2, -2}) {
      const double before = ellipse_um(design.own, feed, turns), after = ellipse_um(design.matched, feed, turns);
      std::printf("%s, %3.0f mm/s, %s: ellipse own %6.2f um, matched %5.2f um\n",
                  GetParam() ? "zero phase" : "velocity", feed, turns > 0 ? "ccw" : "cw", before, after);
      EXPECT_LE(after, 0.5) << feed;
    }
}

/// The forecast agrees with the plants if neither friction nor the encoder's resolution hides the error.
TEST_P(Machine, TheForecastIsWhatTheAxesDo) {
  const host::MachineDesign design = designed(quiet_machine(), GetParam());
  for (const host::LoopSet* set : {&design.own, &design.matched})
    for (const host::FeedContour& forecast : set->contour) {
      const double done = line_error_um(quiet_machine(), *set, 45.0, forecast.feed_mm_s, false, 0.0);
      std::printf("%3.0f mm/s: forecast %6.2f um, simulated %6.2f um\n", forecast.feed_mm_s, forecast.line_45_um, done);
      EXPECT_NEAR(done, forecast.line_45_um, 0.05 * forecast.line_45_um + 0.15) << forecast.feed_mm_s;
    }
}

INSTANTIATE_TEST_SUITE_P(Feedforward, Machine, testing::Values(true, false),
                         [](const auto& which) { return which.param ? "ZeroPhase" : "Velocity"; });

TEST(MachineDesign, TheSlowestAxisSetsThePace) {
  const host::MachineDesign design = designed(machine(), true);
  ASSERT_EQ(design.matched.axes.size(), 2u);
  const auto bandwidth = [](const host::AxisLoop& loop) { return loop.design.used.bandwidth_Hz; };
  EXPECT_EQ(bandwidth(design.matched.axes[0]), bandwidth(design.matched.axes[1]));
  EXPECT_GT(bandwidth(design.own.axes[0]), 1.2 * bandwidth(design.own.axes[1]));
  EXPECT_NEAR(bandwidth(design.matched.axes[0]), bandwidth(design.own.axes[1]), 0.15 * bandwidth(design.own.axes[1]));
  EXPECT_EQ(design.limited_by, "axis y, which keeps a modulus margin of 0.4 no further");
  EXPECT_EQ(designed({machine()[1], machine()[0]}, true).limited_by, design.limited_by)
      << "the order of the models does not matter";
  for (const host::LoopSet* set : {&design.matched, &design.own})
    for (const host::AxisLoop& loop : set->axes) EXPECT_GE(*loop.modulus, 0.4) << loop.model.name;
}

/// Catches the first of equal axes named alone, as if the other allowed more.
TEST(MachineDesign, EqualAxesLimitItTogether) {
  const Tasks equal{{drive("x", 1.0, 8e-4), {}}, {drive("y", 1.0, 8e-4), {}}};
  EXPECT_EQ(designed(equal, true).limited_by, "axes x and y, which keep a modulus margin of 0.4 no further");
}

/// Catches an axis that is called slow although only the estimator without a tachometer, which its neighbour needs,
/// slows it down.
TEST(MachineDesign, SaysThatAnAxisIsLimitedByWhatItShares) {
  Tasks tasks{{drive("x", 1.0, 8e-4), {}}, {drive("y", 1.0, 3e-4), {}}};
  tasks[1].model.data.tach_noise_variance.reset();
  const host::MachineDesign design = designed(tasks, true);
  const double matched_Hz = design.matched.axes[0].design.used.bandwidth_Hz;
  ASSERT_GT(design.own.axes[0].design.used.bandwidth_Hz, 1.1 * matched_Hz);
  EXPECT_NE(design.limited_by.find("axis x, which keeps a modulus margin of 0.4 no further with the estimator"),
            std::string::npos)
      << design.limited_by;
}

TEST(MachineDesign, EstimatorsHaveEqualPoles) {
  const host::MachineDesign design = designed(machine(), true);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto x = design.matched.axes[0].design.observer_poles[k], y = design.matched.axes[1].design.observer_poles[k];
    EXPECT_NEAR(std::abs(x - y), 0.0, 1e-3);
  }
}

/// Catches an estimator that is faster than one of the axes was found to bear.
TEST(MachineDesign, TheCalmestEstimatorSetsThePace) {
  Tasks tasks = machine();
  tasks[0].disturbance_variance = 0.1;
  tasks[1].disturbance_variance = 1e-3;
  const host::MachineDesign design = designed(tasks, true);
  const auto slowest_Hz = [](const host::AxisLoop& loop) { return loop.design.observer_fn_Hz.front(); };
  EXPECT_NEAR(slowest_Hz(design.matched.axes[0]), slowest_Hz(design.matched.axes[1]), 0.5);
  EXPECT_NEAR(slowest_Hz(design.matched.axes[1]), slowest_Hz(design.own.axes[1]), 0.5);
  EXPECT_GT(slowest_Hz(design.own.axes[0]), 1.5 * slowest_Hz(design.own.axes[1]));
}

/// A linear motor and a screw drive: lengths in m and mm, one of them without a tachometer.
TEST(MachineDesign, ServesAxesOfDifferentKinds) {
  sim::DriveDescription linear;
  linear.name = "y";
  linear.data.kind = sim::DriveKind::linear;
  linear.data.force_constant_N_per_V = 35.0;
  linear.data.encoder_resolution = 1e-6;
  linear.data.dac_resolution_V = 20.0 / 65536.0;
  linear.effects = {effect("inertia", {{"J", 20.0}}), effect("viscous", {{"B", 60.0}})};
  const host::MachineDesign design = host::design_machine({{drive("x", 1.0, 3e-4), {}}, {linear, {}}}, {}, {});
  EXPECT_EQ(design.matched.axes[0].design.Kobs.cols(), 1);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(
        std::abs(design.matched.axes[0].design.observer_poles[k] - design.matched.axes[1].design.observer_poles[k]),
        0.0, 2e-3);
  EXPECT_LT(design.matched.contour.back().line_45_um, 0.3 * design.own.contour.back().line_45_um + 0.5);
}

TEST(MachineDesign, RefusesWhatIsNoMachine) {
  EXPECT_THROW(host::design_machine({machine()[0], machine()[0]}, {}, {}), host::Failure) << "one name";
  auto slow = machine()[1];
  slow.model.data.sample_period_s = 2e-3;
  EXPECT_THROW(host::design_machine({machine()[0], slow}, {}, {}), host::Failure) << "two rates";
  host::LoopAim aim;
  aim.modulus = 0.95;
  EXPECT_THROW(host::design_machine(machine(), {}, aim), host::Failure) << "no such margin";
}

}  // namespace
