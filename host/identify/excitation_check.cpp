#include "host/identify/excitation_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

constexpr double kLeastEachWay_s = 0.1;

const char* speed_unit(const sim::DataSheet& data) { return data.kind == sim::DriveKind::rotary ? "rad/s" : "m/s"; }

double percentile_of_magnitude(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  for (double& value : values) value = std::abs(value);
  return quantile(std::move(values), share);
}

/// The largest command, or the largest current if there is no command.
std::string largest_seen(const ExcitationSummary& summary) {
  return summary.peak_command_V > 0.0 || summary.peak_current_A == 0.0
             ? fmt::format("commands up to {:.2g} V", summary.peak_command_V)
             : fmt::format("currents up to {:.2g} A", summary.peak_current_A);
}

/// The recommended excitation, in volts if the command was logged.
std::string better_excitation(const ExcitationSummary& summary, const sim::DataSheet& data) {
  std::string amplitude = "larger steps";
  if (summary.peak_command_V == 0.0 && summary.peak_current_A > 0.0)
    amplitude =
        fmt::format("steps of about ±{:.2g} A (twice what was seen), larger still if the axis does not break away",
                    2.0 * summary.peak_current_A);
  if (summary.peak_command_V > 0.0) {
    const double suggested = std::min(data.dac_limit_V, 2.0 * summary.peak_command_V);
    amplitude =
        summary.peak_command_V < 0.99 * data.dac_limit_V
            ? fmt::format(
                  "steps of about ±{:.2g} V (twice what was tried; the converter gives {:g} V), larger "
                  "still if the axis does not break away",
                  suggested, data.dac_limit_V)
            : fmt::format("the full ±{:g} V; if the axis still does not move, check drive enable, brake and amplifier",
                          data.dac_limit_V);
  }
  return fmt::format(
      "Excite it with {}, in both directions, each held for 0.1 s or more so that several speeds well above {:g} {} "
      "are "
      "reached",
      amplitude, summary.threshold, speed_unit(data));
}

}  // namespace

ExcitationSummary summarise_excitation(const std::vector<Record>& records, const std::vector<Motion>& motions,
                                       const sim::DataSheet& data) {
  ExcitationSummary summary;
  std::vector<double> efforts;
  for (const Motion& motion : motions) {
    for (const double w : motion.speed) summary.top_speed = std::max(summary.top_speed, std::abs(w));
    efforts.insert(efforts.end(), motion.effort.begin(), motion.effort.end());
  }
  for (const Record& record : records) {
    for (const double u : record.u_V) summary.peak_command_V = std::max(summary.peak_command_V, std::abs(u));
    for (const double i : record.i_A) summary.peak_current_A = std::max(summary.peak_current_A, std::abs(i));
  }
  summary.peak_effort = percentile_of_magnitude(std::move(efforts), 0.99);
  // Without a dead band: a hundredth of the top speed, and more than the encoder's last digit can show in 0.1 s.
  const double fake = data.encoder_resolution / data.lead / kLeastEachWay_s * 10.0;
  summary.threshold = motions.front().deadband;
  if (!(summary.threshold > 0.0)) summary.threshold = std::max(0.01 * summary.top_speed, fake);
  for (const Motion& motion : motions) {
    for (const double w : motion.speed) {
      if (w > summary.threshold) summary.forward_s += 1.0 / motion.sample_rate_Hz;
      if (w < -summary.threshold) summary.backward_s += 1.0 / motion.sample_rate_Hz;
    }
  }
  return summary;
}

void require_motion(const ExcitationSummary& summary, const sim::DataSheet& data) {
  const bool forward = summary.forward_s >= kLeastEachWay_s, backward = summary.backward_s >= kLeastEachWay_s;
  if (forward && backward) return;
  const char* what = forward || backward ? "the axis moved in one direction only" : "the axis did not move enough";
  throw Failure(ExitCode::refused,
                fmt::format("{}: {:.2f} s forward and {:.2f} s backward beyond {:g} {}, at {}. {}.", what,
                            summary.forward_s, summary.backward_s, summary.threshold, speed_unit(data),
                            largest_seen(summary), better_excitation(summary, data)));
}

void require_determined(const RigidEstimate& estimate, const ExcitationSummary& summary, const sim::DataSheet& data) {
  if (std::isfinite(estimate.condition_number) && estimate.inertia.ci95[1] < 0.0)
    throw Failure(
        ExitCode::refused,
        fmt::format("the estimated inertia is negative ({:.4g}): the axis accelerates against its command. The "
                    "sign of the command or of the motion is inverted, or channels are swapped",
                    estimate.inertia.value));
  const bool determined = std::isfinite(estimate.condition_number) && estimate.inertia.ci95[0] > 0.0;
  if (determined) return;
  throw Failure(
      ExitCode::refused,
      fmt::format("the record does not determine the inertia (condition number {:.3g}): the speed changes too little "
                  "or too seldom. {}. If only constant speeds are possible, write a model by hand with the data "
                  "sheet's inertia held fixed ({}_held = true); axistool diagnose then fits the friction.",
                  estimate.condition_number, better_excitation(summary, data),
                  data.kind == sim::DriveKind::rotary ? "J_kg_m2" : "M_kg"));
}

std::vector<std::string> judge_estimate(const RigidEstimate& estimate, const ExcitationSummary& summary,
                                        const sim::DataSheet& data) {
  // At Ku = 5 of the paper, friction takes 47 % (x) and 57 % (y) of the torque of the motor, at 7.5 it takes 32 % and
  // 38 %.
  constexpr double kDominantShare = 0.4;
  constexpr double kWideInterval = 0.05;
  std::vector<std::string> warnings;
  if (estimate.positive && estimate.negative) {
    const double friction = std::max(estimate.positive->value, -estimate.negative->value);
    if (friction > kDominantShare * summary.peak_effort) {
      warnings.push_back(
          fmt::format("static friction dominates: friction needs {:.0f} % of the motor's largest torque or force, so "
                      "the estimates are biased. {}.",
                      100.0 * friction / summary.peak_effort, better_excitation(summary, data)));
    }
  }
  if (estimate.inertia.half_width() > kWideInterval * estimate.inertia.value) {
    warnings.push_back(
        fmt::format("the inertia is known only to ±{:.0f} %: use stronger steps in both directions, or more records",
                    100.0 * estimate.inertia.half_width() / estimate.inertia.value));
  }
  if (estimate.condition_number > kPoorCondition) {
    warnings.push_back(
        fmt::format("the record hardly separates the parameters (condition number {:.0f}): vary amplitude "
                    "and duration of the steps",
                    estimate.condition_number));
  }
  return warnings;
}

}  // namespace host
