// The board's estimate of a process force: disturbance less friction feed-forward, beside the force itself, on a
// machine that shares no code with the simulator.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <vector>

#include "firmware/core/path/path_follower.hpp"
#include "host/device/capture.hpp"
#include "host/device/motion.hpp"
#include "host/device/path_run.hpp"
#include "host/gcode/program.hpp"
#include "host/identify/force_estimate.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "host/parameters/board_parameters.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/parameters/parameter_names.hpp"
#include "tests/host/commission/own_machine.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

constexpr double kEffort = 3.0, kLead_m = 1.6e-3;  // of OwnMachine, Nm/V and m/rad

/// True values, which commissioning would find.
sim::DriveDescription true_model() {
  sim::DriveDescription model = own_sheet();
  model.data.amplifier_gain_A_per_V = kEffort / model.data.torque_constant_Nm_per_A;
  model.effects = {{"inertia", {{"J", 0.008}}, {}, {}},
                   {"viscous", {{"B", 0.03}}, {}, {}},
                   {"coulomb", {{"positive", 2.0}, {"negative", -2.0}}, {}, {}}};
  return model;
}

/// Half immersion up milling with one tooth at a time: the chip grows from nothing at the entry to its full thickness
/// at the exit, where the force ends at once. The tooth is in the cut for half of its period.
double milling_N(double t_s, double peak_N, double tooth_Hz) {
  const double turn = t_s * tooth_Hz - std::floor(t_s * tooth_Hz);
  return turn < 0.5 ? peak_N * std::sin(std::numbers::pi * turn) : 0.0;
}

/// What acted on the machine in a control period, and where the axis was at its start.
struct Moment {
  double force_N, position;
};

struct Estimate {
  double error_N = 0.0, delayed_error_N = 0.0;  ///< RMS, at the same time and at the best delay
  int delay_ms = 0;
  double moved_um = 0.0;  ///< RMS of the position against its reference, without its mean
};

class ProcessForce : public testing::Test {
 protected:
  ProcessForce() : client_(board_.client()) {}

  host::ForceEstimate use(double disturbance_variance, const std::vector<host::Assignment>& further = {}) {
    const sim::DriveDescription model = true_model();
    host::DesignOptions options;
    options.bandwidth_Hz = 20.0;
    options.disturbance_variance = disturbance_variance;
    options.tach_variance = 0.01;
    firmware::ParameterValues values = client_.read_values();
    const std::string text =
        host::board_parameters_toml(model, host::design_axis(model, options), {100.0, 1000.0, 3e4});
    for (const host::Assignment& one : host::parse_parameter_text(text, "design", "x")) host::put(values, one);
    for (const host::Assignment& one : further) host::put(values, one);
    client_.write_values(values);
    estimator_ = host::estimator_of(values.axis(0));
    return host::force_estimate(host::design_axis(model, options), model.data);
  }

  Estimate cut(double peak_N, double tooth_Hz) {
    std::map<long, Moment> true_moments;
    board_.machine->process_N = [&](double t_s) {
      const double force_N = milling_N(t_s, peak_N, tooth_Hz);
      true_moments.try_emplace(std::lround(std::floor(t_s * 1e3 - 1e-6)), Moment{force_N, board_.machine->position()});
      return force_N;
    };
    host::enable_and_wait(client_, 1);
    host::CaptureSettings settings;
    using firmware::Channel;
    settings.channels = {Channel::counts, Channel::reference, Channel::reference_velocity, Channel::disturbance,
                         Channel::friction};
    settings.duration_s = 0.0;
    settings.jogs = {{20.0, 1.7}};
    const host::Capture seen = host::run_capture(client_, settings);
    host::disable_and_wait(client_, 1);
    board_.machine->process_N = nullptr;
    host::Record record = host::capture_record(seen, settings, "x");
    host::add_process_force(record, true_model(), estimator_);
    EXPECT_EQ(record.extra.back().name, "process_force_N");
    return compared(record, true_moments);
  }

  OwnBoard board_;
  host::BoardClient client_;

 private:
  /// Rows from 0.5 s to 1.5 s: whole periods of the tooth. The rows' place in the machine's time is that at which all
  /// encoder readings agree.
  static Estimate compared(const host::Record& seen, const std::map<long, Moment>& true_moments) {
    const std::vector<double>&x = seen.x, &reference = seen.x_ref, &estimate_N = seen.extra.back().values;
    constexpr std::size_t kBegin = 500, kEnd = 1500;
    constexpr long kMostDelay = 60;
    Estimate found;
    if (x.size() < kEnd) return found;
    long place = 0;
    double least = HUGE_VAL;
    for (auto at = true_moments.begin(); at != true_moments.end(); ++at) {
      const double off = std::abs(at->second.position - x[kBegin]);
      if (off >= least) continue;
      least = off;
      place = at->first - static_cast<long>(kBegin);
    }
    const auto force_at = [&](std::size_t k, long delay) {
      return true_moments.at(place + static_cast<long>(k) - delay).force_N;
    };
    const auto error_N = [&](long delay) {
      double squares = 0.0;
      for (std::size_t k = kBegin; k < kEnd; ++k) squares += std::pow(estimate_N[k] - force_at(k, delay), 2);
      return std::sqrt(squares / static_cast<double>(kEnd - kBegin));
    };
    found.error_N = error_N(0);
    found.delayed_error_N = HUGE_VAL;
    for (long delay = 0; delay < kMostDelay; ++delay)
      if (const double error = error_N(delay); error < found.delayed_error_N) {
        found.delayed_error_N = error;
        found.delay_ms = static_cast<int>(delay);
      }
    double mean = 0.0, squares = 0.0;
    for (std::size_t k = kBegin; k < kEnd; ++k) mean += (reference[k] - x[k]) / static_cast<double>(kEnd - kBegin);
    for (std::size_t k = kBegin; k < kEnd; ++k) squares += std::pow(reference[k] - x[k] - mean, 2);
    found.moved_um = 1e3 * std::sqrt(squares / static_cast<double>(kEnd - kBegin));
    return found;
  }

  Eigen::Matrix<double, 3, Eigen::Dynamic> estimator_;
};

/// Catches an estimate in a wrong unit, of the wrong sign or with friction in it; a band that contains far fewer or
/// more than 95 % of the estimates; and a wrong delay. Rwd of 1 V2 is left out: its noise hides the force.
TEST_F(ProcessForce, IsSeenWithinTheBandAndTheDelayThatAreStated) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  constexpr double kPeak_N = 400.0, kTooth_Hz = 10.0;
  Estimate before;
  for (const double variance : {1e-4, 1e-3, 1e-2, 1e-1}) {
    const host::ForceEstimate stated = use(variance);
    const Estimate idle = cut(0.0, kTooth_Hz), found = cut(kPeak_N, kTooth_Hz);
    std::printf(
        "Rwd %g V2: without force %.1f N RMS, band +-%.1f N; error %.1f N RMS, %.1f N after a delay of %d ms "
        "(stated %.1f ms); axis moves %.2f um RMS\n",
        variance, idle.error_N, stated.band_N, found.error_N, found.delayed_error_N, found.delay_ms,
        1e3 * stated.delay_s, found.moved_um);
    EXPECT_NEAR(1.96 * idle.error_N, stated.band_N, 0.25 * stated.band_N) << variance;
    EXPECT_NEAR(found.delay_ms, 1e3 * stated.delay_s, 1.5) << variance;
    EXPECT_LT(found.delayed_error_N, std::hypot(1.1 * idle.error_N, 0.25 * kPeak_N / 2.0)) << variance;
    if (before.delay_ms > 0) {
      EXPECT_LT(found.delay_ms, before.delay_ms) << variance;
    }
    before = found;
  }
}

/// Catches a column that contains friction if the board does not feed it forward, or subtracts it twice if it does.
TEST_F(ProcessForce, IsTheSameColumnWithoutFrictionFeedforward) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  use(1e-2);
  const Estimate with = cut(400.0, 10.0);
  use(1e-2, {{host::require_place("x.feedforward.friction"), 0.0F}});
  const Estimate without = cut(400.0, 10.0);
  std::printf("error with friction feed-forward %.1f N RMS, without %.1f N RMS\n", with.delayed_error_N,
              without.delayed_error_N);
  EXPECT_NEAR(without.delayed_error_N, with.delayed_error_N, 0.1 * with.delayed_error_N);
}

/// Catches a limit that does not act, that acts on friction that is fed forward, or that a feed override releases; axes
/// that leave the path; and a hold that the operator cannot release.
TEST_F(ProcessForce, HoldsTheFeedAboveItsLimitUntilReleased) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  constexpr double kLimit_N = 500.0, kGrowth_N_s = 2000.0, kFeed_mm_s = 20.0, kLength_mm = 60.0;
  const host::ForceEstimate stated =
      use(1e-4, {{host::require_place("x.feedback.hold_effort"), static_cast<float>(kLimit_N * kLead_m)}});
  double begins_s = 0.0, free_at_N = 0.0, held_at_N = 0.0;  // force at the last poll before the hold, and at the next
  double now_s = 0.0;
  const auto force_now_N = [&] { return begins_s > 0.0 ? kGrowth_N_s * (now_s - begins_s) : 0.0; };
  board_.machine->process_N = [&](double t_s) {
    now_s = t_s;
    return force_now_N();
  };
  host::enable_and_wait(client_, 1);
  const host::PathBoard machine = host::path_board(client_.read_values(), 1);
  host::GcodeMachine any;
  any.axes = 1;
  const std::string program = fmt::format("G21 G91 F{} G1 X{}\nM2\n", 60.0 * kFeed_mm_s, kLength_mm);
  host::PathPlanOptions options;
  options.limits = machine.limits;
  options.time_unit_s = 1.0 / machine.scale.rate_Hz / (1u << firmware::kPathTimeBits);
  const host::PlannedPath path =
      host::plan_path(host::read_gcode(program, "line", host::PathPoint::Zero(), any).moves, options);
  host::PathRecorder recorder(client_, machine);
  int polls = 0, polls_held = 0;
  double elapsed_at_rest_s = 0.0;
  const host::PathOutcome done =
      host::run_path(client_, path, machine, true, recorder, [&](const host::PathProgress& progress) {
        host::PathWish wish;
        wish.stop = ++polls > 2000;
        if (progress.elapsed_s > 1.0 && begins_s == 0.0) begins_s = now_s;
        if (progress.state.held == firmware::kHeldForProcess) {
          if (++polls_held == 1) held_at_N = force_now_N();
          if (polls_held == 40) elapsed_at_rest_s = progress.elapsed_s;
          if (polls_held == 60) board_.machine->process_N = nullptr;
          if (polls_held >= 60) return wish;
        }
        if (polls_held == 0) free_at_N = force_now_N();
        wish.held = polls_held > 0 && polls_held < 60;
        return wish;
      });
  recorder.stop();
  host::disable_and_wait(client_, 1);
  // Once the force exceeds the limit by the band of the estimate, which lags behind by its delay, 97.5 % of the
  // estimates are above the limit and 2.5 % below. The feed is held after 1/33 s more above than below.
  constexpr double kExcess_s = 1.0 / 33.0 / 0.95;
  const double latest_N = kLimit_N + stated.band_N + kGrowth_N_s * (stated.delay_s + kExcess_s);
  const double earliest_N = kLimit_N - stated.band_N + kGrowth_N_s * stated.delay_s;
  std::printf(
      "limit %.0f N: feed held between %.0f N and %.0f N (may be %.0f to %.0f N), at rest after %.3f s of %.3f s\n",
      kLimit_N, free_at_N, held_at_N, earliest_N, latest_N, elapsed_at_rest_s, path.duration_s());
  EXPECT_EQ(polls_held, 60);
  EXPECT_GT(held_at_N, earliest_N);
  EXPECT_LT(free_at_N, latest_N);
  EXPECT_LT(elapsed_at_rest_s, 0.7 * path.duration_s());
  EXPECT_EQ(static_cast<firmware::PathEnd>(done.state.end), firmware::PathEnd::completed);
  EXPECT_EQ(done.state.held, 0);
}

}  // namespace
