// After any fault at any sample of any motion, both axes end at rest with outputs off, and the fault names its cause.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "host/hil/fault_trial.hpp"
#include "host/read_file.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

using host::FaultTrial;
using host::TrialMotion;
using host::TrialOutcome;

/// Largest values of the trials beyond their ramps, compared with the stated bounds.
struct Worst {
  double extra_s = 0.0, extra_mm = 0.0, gain_s = 0.0;
  std::array<double, 5> extra_mm_by_speed{};  ///< of axes slower than 50, 100, 150, 200 mm/s, and the rest
  std::string slowest, longest, fastest;

  void add(const FaultTrial& trial, const TrialOutcome& outcome) {
    note(outcome.beyond_s, extra_s, trial, slowest);
    note(outcome.beyond_mm, extra_mm, trial, longest);
    note(outcome.gain_s, gain_s, trial, fastest);
    const auto band = std::min(static_cast<std::size_t>(outcome.speed_mm_s / 50.0), extra_mm_by_speed.size() - 1);
    extra_mm_by_speed[band] = std::max(extra_mm_by_speed[band], outcome.beyond_mm);
  }
  /// `seeds`: from 0 up to this one, some left out.
  void print(int trials, int seeds) const {
    std::printf(
        "%d trials, seeds 0 to %d: slowest stop %.3f s beyond the formula (%s)\nlongest way %.1f mm beyond it (%s)\n",
        trials, seeds - 1, extra_s, slowest.c_str(), extra_mm, longest.c_str());
    for (std::size_t band = 0; band < extra_mm_by_speed.size(); ++band)
      std::printf("%s%zu mm/s %.1f mm", band == 0 ? "by speed, from: " : ", ", 50 * band, extra_mm_by_speed[band]);
    std::printf("\nsped up for %.4f s at most (%s)\n", gain_s, fastest.c_str());
  }

 private:
  static void note(double found, double& most, const FaultTrial& trial, std::string& which) {
    if (found <= most) return;
    most = found;
    which = trial.text();
  }
};

/// Empty if the trial ended as required.
std::string what_is_wrong(const FaultTrial& trial, const TrialOutcome& outcome) {
  std::string wrong;
  if (!outcome.is_safe) wrong += ", not safe";
  if (!outcome.is_latched) wrong += ", an axis is not in its fault";
  if (!outcome.is_named) wrong += ", not the cause";
  if (outcome.beyond_s > host::kStatedExtra_s) wrong += ", too late";
  if (outcome.beyond_mm > host::kStatedExtra_mm) wrong += ", too far";
  if (outcome.gain_s > host::kStatedGain_s) wrong += ", too fast";
  if (outcome.driven_off_s > host::kStatedCut_s + 0.5e-3 * trial.start.ready_ms) wrong += ", driven too long";
  if (wrong.empty()) return wrong;
  return fmt::format(
      "{}: {} after {:g} s, stood after {:g} s and {:g} mm, {:g} s and {:g} mm beyond the formula, sped up for {:g} "
      "s{}",
      trial.text(), firmware::fault_info(outcome.fault).name, outcome.reaction_s, outcome.stop_s, outcome.distance_mm,
      outcome.beyond_s, outcome.beyond_mm, outcome.gain_s, wrong);
}

using Random = std::mt19937_64;
int any_of(Random& random, int least, int most) { return std::uniform_int_distribution<int>(least, most)(random); }
bool either(Random& random) { return any_of(random, 0, 1) == 0; }

bool is_of_tachometer(const host::TrialInjection& what) { return what.injection->kind.starts_with("tachometer"); }

host::TrialInjection any_value(Random& random, const host::InjectionInfo& info) {
  host::TrialInjection what{&info, static_cast<std::size_t>(any_of(random, 0, 1)),
                            info.least * (1.0 + any_of(random, 0, 200) / 100.0)};
  if (info.kind == "dac_stuck" || info.kind == "amplifier_stuck") what.value = std::min(what.value, 9.9);
  if (either(random) && info.kind != "control_late") what.value = -what.value;
  return what;
}

/// Pairs that are undetectable together: the second reversal cancels the first and no tachometer shows it, or counts
/// are lost and gained.
bool cancel_each_other(const FaultTrial& trial) {
  const bool both_count = trial.first.injection->kind == "counts_lost" && trial.second.injection->kind == "counts_lost";
  if (both_count && trial.first.axis == trial.second.axis && trial.delay == 0 &&
      std::abs(trial.first.value + trial.second.value) < trial.first.injection->least)
    return true;
  const auto are = [&](std::string_view one, std::string_view other) {
    return trial.first.injection->kind == one && trial.second.injection->kind == other;
  };
  return !trial.tachometer && trial.first.axis == trial.second.axis &&
         (are("motor_reversed", "encoder_swapped") || are("encoder_swapped", "motor_reversed"));
}

using Needs = host::InjectionInfo::Needs;
bool needs(const FaultTrial& trial, Needs what) {
  return trial.first.injection->needs == what ||
         (trial.second.injection != nullptr && trial.second.injection->needs == what);
}

/// Without a tachometer or its receivers' report, a dead encoder hides the effect of a stuck converter until the loop
/// closes. A ready contact that cannot close hides an amplifier that drives by itself. If both sensors die before the
/// loop closes, and no receivers report it, nothing shows that a weight moves the axis.
bool is_blind(const FaultTrial& trial) {
  if (trial.second.injection == nullptr || trial.first.axis != trial.second.axis) return false;
  const auto are = [&](std::string_view one, std::string_view other) {
    const std::string_view first = trial.first.injection->kind, second = trial.second.injection->kind;
    return (first == one && second == other) || (first == other && second == one);
  };
  if (are("unready", "amplifier_stuck")) return true;
  const bool may_be_open = trial.motion == TrialMotion::self_test || trial.motion == TrialMotion::ready ||
                           trial.motion == TrialMotion::starting || trial.motion == TrialMotion::stopping;
  if (may_be_open && trial.weight_Nm != 0.0 && !trial.encoder_fault_input && are("encoder_cut", "tachometer_dead"))
    return true;
  return !trial.tachometer && !trial.encoder_fault_input && trial.start.ready_ms != 0 &&
         (are("encoder_cut", "dac_stuck") || are("encoder_cut", "amplifier_offset") ||
          are("encoder_cut", "amplifier_stuck"));
}

/// Slow amplifiers, with and without the ready contact; brakes; a weight that friction does not hold.
void set_up_start(FaultTrial& trial, Random& random) {
  trial.start.ready_input = needs(trial, Needs::ready_input) || any_of(random, 0, 2) == 0;
  trial.start.brake = needs(trial, Needs::brake) || any_of(random, 0, 2) == 0;
  if (trial.first.injection->needs == Needs::open_loop) {
    trial.motion = TrialMotion::starting;
    trial.start.brake = false;
  }
  trial.encoder_fault_input = needs(trial, Needs::encoder_fault_input) || any_of(random, 0, 2) == 0;
  if (trial.start.brake && !trial.encoder_fault_input) trial.tachometer = true;  // as the board requires
  trial.start.ready_ms = any_of(random, 0, 250);
  if (either(random) && trial.motion != TrialMotion::starting) trial.start.ready_ms = 0;
  if (trial.start.ready_input || trial.motion == TrialMotion::starting)
    trial.start.ready_ms = std::max(trial.start.ready_ms, 60);
  trial.light = any_of(random, 0, 2) == 0;
  const double weight_Nm = trial.light ? 3.0 : 5.0;
  if (trial.start.brake && either(random)) trial.weight_Nm = either(random) ? weight_Nm : -weight_Nm;
}

/// Common part of the tests with one fault and with two.
void set_up(FaultTrial& trial, Random& random) {
  trial.motion = static_cast<TrialMotion>(any_of(random, 0, 7));
  set_up_start(trial, random);
  trial.acceleration_mm_s2 = trial.motion == TrialMotion::circle || either(random) ? 2000.0 : 200.0;
  // A board needs two samples before it can compare.
  const int latest = trial.acceleration_mm_s2 < 1000.0 ? 1500 : 700;
  trial.sample = any_of(random, 2, trial.motion == TrialMotion::self_test ? 50 : latest);
  if (trial.motion == TrialMotion::starting) {
    const int closes = trial.start.ready_input ? trial.start.ready_ms / 2 : trial.start.ready_ms;
    const bool is_open = trial.first.injection->needs == Needs::open_loop;
    trial.sample = any_of(random, 0, is_open ? closes - 20 : closes + 2 * host::kTrialBrake_ms);
  }
  if (trial.motion == TrialMotion::stopping && either(random)) trial.since_disable = any_of(random, 0, latest);
  // While the drive moves very slowly, a failing tachometer stays within the monitors' thresholds.
  const bool crawls =
      !is_of_tachometer(trial.first) && (trial.second.injection == nullptr || !is_of_tachometer(trial.second));
  trial.speed_mm_s = any_of(random, crawls ? 2 : 40, 250) * (either(random) ? 1.0 : -1.0);
  trial.seed = static_cast<std::uint64_t>(any_of(random, 0, 1 << 30));
}

int trials_asked_for(int usual) {
  const char* wanted = std::getenv("AXIS_FAULT_TRIALS");
  return wanted != nullptr ? std::atoi(wanted) : usual;
}
#ifdef AXIS_INSTRUMENTED
constexpr int kShort = 20;
#else
constexpr int kShort = 1;
#endif

TEST(AnyFault, EndsWithBothAxesStandingAndNamesItsCause) {
  Worst worst;
  const int trials = trials_asked_for(3000 / kShort);
  for (int number = 0; number < trials; ++number) {
    Random random(static_cast<std::uint64_t>(number));
    FaultTrial trial;
    trial.tachometer = either(random);
    const auto all = host::injections();
    do {
      trial.first =
          any_value(random, all[static_cast<std::size_t>(any_of(random, 0, static_cast<int>(all.size()) - 1))]);
    } while (!trial.tachometer && is_of_tachometer(trial.first));
    set_up(trial, random);
    const TrialOutcome outcome = host::run_trial(trial);
    worst.add(trial, outcome);
    EXPECT_EQ(what_is_wrong(trial, outcome), "") << "seed " << number;
  }
  worst.print(trials, trials);
}

/// Every fault before, with and after every other. Runs one trial for each pair and each of the two kinds of axes;
/// AXIS_FAULT_TRIALS sets a larger number (`make soak`).
TEST(AnyTwoFaults, EndWithBothAxesStandingAndTheFirstCauseNamed) {
  Worst worst;
  const int wanted = trials_asked_for(1000 / kShort);
  const auto all = host::injections();
  int trials = 0, number = 0;
  for (; trials < wanted; ++number) {
    // Visits the pairs in steps that are coprime to their number, so that a shorter run samples them evenly.
    const std::size_t pairs = all.size() * all.size();
    const std::size_t pair = static_cast<std::size_t>(number) * 101 % pairs;
    Random random(static_cast<std::uint64_t>(number) + 1'000'000);
    FaultTrial trial;
    trial.tachometer = either(random);
    trial.first = any_value(random, all[pair / all.size()]);
    trial.second = any_value(random, all[pair % all.size()]);
    const bool needs_tachometer = is_of_tachometer(trial.first) || is_of_tachometer(trial.second);
    trial.tachometer = trial.tachometer || needs_tachometer;
    trial.delay = either(random) ? any_of(random, 0, 100) : any_of(random, 0, 1000);
    if (cancel_each_other(trial)) continue;
    set_up(trial, random);
    if (is_blind(trial)) continue;
    const TrialOutcome outcome = host::run_trial(trial);
    worst.add(trial, outcome);
    EXPECT_EQ(what_is_wrong(trial, outcome), "") << "seed " << number;
    ++trials;
  }
  worst.print(trials, number);
}

/// Every pair with its first fault in every sample of enabling, and of a stop from a jog, the second 0 to 60 samples
/// later. A shorter run samples them evenly; AXIS_FAULT_MOMENTS sets their number (`make soak`: all).
TEST(AnyTwoFaults, AtEveryMomentOfEnablingAndDisablingDoTheSame) {
  constexpr int kEnabling = 170, kDisabling = 260;  // ready after 60 ms, brake 50 ms; ramp 165 ms, rest, brake
  const auto all = host::injections();
  const int pairs = static_cast<int>(all.size() * all.size()), moments = kEnabling + kDisabling;
  const char* asked = std::getenv("AXIS_FAULT_MOMENTS");
  const int wanted = std::min(asked != nullptr ? std::atoi(asked) : 600 / kShort, pairs * moments);
  Worst worst;
  for (int number = 0; number < wanted; ++number) {
    // Steps by a prime that does not divide their number visit each combination once.
    const auto which = static_cast<int>(std::int64_t{number} * 100'003 % (pairs * moments));
    const auto pair = static_cast<std::size_t>(which / moments);
    Random random(static_cast<std::uint64_t>(which) + 10'000'000);
    FaultTrial trial;
    trial.first = any_value(random, all[pair / all.size()]);
    trial.second = any_value(random, all[pair % all.size()]);
    trial.delay = any_of(random, 0, 60);
    trial.tachometer = either(random) || is_of_tachometer(trial.first) || is_of_tachometer(trial.second);
    if (cancel_each_other(trial)) continue;
    set_up_start(trial, random);
    const int moment = which % moments;
    const bool opens_loop = trial.first.injection->needs == Needs::open_loop;
    trial.motion = moment < kEnabling || opens_loop ? TrialMotion::starting : TrialMotion::stopping;
    trial.sample = moment < kEnabling ? moment : 300;
    trial.since_disable = moment < kEnabling ? 0 : moment - kEnabling;
    if (trial.motion == TrialMotion::starting) {
      trial.start.ready_ms = 60;
      if (opens_loop) trial.sample = moment % (trial.start.ready_input ? 10 : 40);
    }
    if (is_blind(trial)) continue;
    trial.speed_mm_s = any_of(random, 40, 250) * (either(random) ? 1.0 : -1.0);
    trial.seed = static_cast<std::uint64_t>(number);
    const TrialOutcome outcome = host::run_trial(trial);
    worst.add(trial, outcome);
    EXPECT_EQ(what_is_wrong(trial, outcome), "") << "number " << number;
  }
  worst.print(wanted, wanted);
}

/// A dead encoder that nothing reports, on an axis without a tachometer.
TEST(DeadEncoder, LetsASlowJogGoOnForATenthOfItsPitchAtMost) {
  for (const double speed_mm_s : {2.0, 5.0, 10.0, -10.0, 20.0}) {
    for (const std::size_t axis : {0, 1}) {
      const FaultTrial trial{.first = {host::find_injection("encoder_cut"), axis, 0.0},
                             .second = {},
                             .sample = 500,
                             .speed_mm_s = speed_mm_s,
                             .tachometer = false};
      const TrialOutcome outcome = host::run_trial(trial);
      EXPECT_EQ(outcome.fault, firmware::AxisFault::command_without_motion) << trial.text();
      EXPECT_LT(outcome.whole_way_mm, 10.0) << trial.text();
    }
  }
}

/// The receivers of an encoder that is unplugged at rest report it, so that the brake holds the weight. If both
/// sensors die before an axis is enabled, nothing else shows it (is_blind).
TEST(DeadEncoder, OfAnAxisUnderWeightIsFoundAtRestByItsReceivers) {
  for (const bool light : {false, true}) {
    const FaultTrial trial{.first = {host::find_injection("encoder_cut"), 0, 0.0},
                           .second = {},
                           .motion = TrialMotion::standing,
                           .tachometer = false,
                           .encoder_fault_input = true,
                           .start = {.brake = true},
                           .weight_Nm = light ? 3.0 : 5.0,
                           .light = light};
    const TrialOutcome outcome = host::run_trial(trial);
    EXPECT_EQ(what_is_wrong(trial, outcome), "");
    EXPECT_EQ(outcome.fault, firmware::AxisFault::encoder_invalid) << trial.text();
    EXPECT_LE(outcome.reaction_s, 0.0041) << "the time of the input filter, and a period: " << trial.text();
    FaultTrial both = trial;
    both.second = {host::find_injection("tachometer_dead"), 0, 0.0};
    both.motion = TrialMotion::ready;
    both.tachometer = true;
    const TrialOutcome found = host::run_trial(both);
    EXPECT_EQ(what_is_wrong(both, found), "");
    EXPECT_EQ(found.fault, firmware::AxisFault::encoder_invalid) << both.text();
  }
}

TEST(FaultPage, IsWhatTheRunGives) {
#ifdef AXIS_INSTRUMENTED
  GTEST_SKIP() << "another compiler's roundings may show in the last digit";
#endif
  EXPECT_EQ(host::read_file(AXIS_TEST_DATA "/../../firmware/core/supervision/README.md"), host::fault_page())
      << "write it anew: build/bin/axistool hil --fault-page > firmware/core/supervision/README.md";
}

}  // namespace
