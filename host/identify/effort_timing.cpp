#include "host/identify/effort_timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "host/exit_codes.hpp"
#include "host/identify/encoder_step.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/identify/least_squares.hpp"
#include "host/identify/motion.hpp"
#include "host/identify/zero_phase_filter.hpp"
#include "host/number.hpp"
#include "host/statistics.hpp"
#include "sim/catalogue.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

constexpr const char *kSamplesKey = "effort_timing_samples", *kDeviationKey = "effort_timing_deviation",
                     *kEstimatedKey = "effort_timing_estimated";

constexpr int kTravelTerms = 8;  // as in least_squares_beside_travel()
constexpr int kTerms = 7 + kTravelTerms;
using Terms = Eigen::Matrix<double, kTerms, 1>;

/// The motion of the record in the samples in which the axis certainly slides. It does not use the drive's usual dead
/// band.
std::optional<Motion> sliding_motion(const Record& record, const sim::DataSheet& data) {
  constexpr double kSlowShare = 0.01;  // of the high speeds; below it, the direction of friction is uncertain
  try {
    MotionOptions options;
    options.cutoff_Hz = choose_cutoff({record}, data);
    std::vector<double> speeds = smooth_speed(record, data, *options.cutoff_Hz);
    for (double& speed : speeds) speed = std::abs(speed);
    const double step = record.has_position() ? encoder_step(record, data) * *options.cutoff_Hz / data.lead : 0.0;
    options.deadband = std::max({kSlowShare * quantile(speeds, 0.95), step, std::numeric_limits<double>::min()});
    return prepare_motion(record, data, options);
  } catch (const Failure&) {  // too short, or without torque or force: no information
    return {};
  }
}

/// The terms of one record at the rows in use; the last term is reserved for the time offset.
std::vector<Terms> terms_of(const Motion& motion) {
  const auto [low, high] = std::ranges::minmax(motion.travel);
  const double length = std::max(high - low, 1e-300);
  double top = 1e-300;
  for (const double speed : motion.speed) top = std::max(top, std::abs(speed));
  constexpr double kLowSpeed = 0.1;  // of the top speed; below it, friction may rise towards standstill
  std::vector<Terms> rows;
  for (std::size_t k = 0; k < motion.speed.size(); ++k) {
    if (!motion.counts[k]) continue;
    const double w = motion.speed[k], sign = w > 0.0 ? 1.0 : -1.0, share = std::abs(w) / top;
    Terms row;
    row.head<6>() << motion.acceleration[k], w, w > 0.0 ? 1.0 : 0.0, w > 0.0 ? 0.0 : 1.0, w * share,
        sign * std::exp(-share / kLowSpeed);
    for (int n = 1; n <= kTravelTerms; ++n)
      row(5 + n) = high > low ? std::cos(n * std::numbers::pi * (motion.travel[k] - low) / length) : 0.0;
    rows.push_back(row);
  }
  return rows;
}

/// Correction of the time at which the torque or force acts, with its variance; empty if the record does not determine
/// it.
struct Step {
  double samples, variance;
};
std::optional<Step> step_of(const Motion& motion, std::vector<Terms>& terms, const std::vector<double>& effort) {
  BlockedRegression<kTerms> regression(rows_per_block(terms.size(), 1.0 / motion.sample_rate_Hz));
  // Terms that a record cannot determine (a direction, the position) become zero and do not make the equations
  // singular.
  constexpr double kNegligible = 1e-6;
  for (int term = 0; term < kTerms; ++term) regression.add(kNegligible * Terms::Unit(term), 0.0);
  std::size_t row = 0;
  double squares = 0.0, slope_squares = 0.0;
  for (std::size_t k = 0; k < motion.counts.size(); ++k) {
    if (!motion.counts[k]) continue;
    // effort - samples * d effort/d row = torque or force that the motion needs
    const double slope = 0.5 * (effort[std::min(k + 1, effort.size() - 1)] - effort[k - std::min<std::size_t>(k, 1)]);
    terms[row](kTerms - 1) = slope;
    regression.add(terms[row++], effort[k]);
    squares += effort[k] * effort[k];
    slope_squares += slope * slope;
  }
  const Regression found = regression.solve();
  const double variance = found.covariance(kTerms - 1, kTerms - 1);
  if (!std::isfinite(found.parameters(kTerms - 1)) || !(variance > 0.0) || !std::isfinite(variance)) return {};
  // If an effect is missing, the residual is larger than noise and may be correlated with the slope of the torque. The
  // correlation is assumed to be as large as the relative residual.
  const double misled = found.relative_residual * found.relative_residual * std::sqrt(squares / slope_squares);
  return Step{found.parameters(kTerms - 1), variance + misled * misled};
}

void write_timing(Record& record, const EffortTiming& timing) {
  record.header[kSamplesKey] = fmt::format("{}", timing.samples);
  record.header[kDeviationKey] = fmt::format("{}", timing.deviation);
  record.header[kEstimatedKey] = "1";
}

/// Corrects the motion for the encoder error of the drive.
void take_off_encoder_error(const sim::Drive& drive, Motion& motion) {
  if (drive.encoder_error.empty()) return;
  std::vector<double> correction(motion.travel.size());
  for (std::size_t k = 0; k < correction.size(); ++k)
    correction[k] = drive.travel_at_reading(motion.travel[k]) - motion.travel[k];
  correction = ZeroPhaseLowPass::butterworth(motion.cutoff_Hz, motion.sample_rate_Hz)(correction);
  const double period_s = 1.0 / motion.sample_rate_Hz;
  const std::vector<double> rate = central_difference(correction, period_s * drive.lead);
  const std::vector<double> rate_of_rate = central_difference(rate, period_s);
  for (std::size_t k = 0; k < correction.size(); ++k) {
    motion.travel[k] += correction[k];
    motion.speed[k] += rate[k];
    motion.acceleration[k] += rate_of_rate[k];
  }
}

/// Torque or force of the effects other than inertia and friction, filtered like the motion; empty if there are none.
std::vector<double> further_effort(const sim::DriveDescription& model, const Motion& motion) {
  sim::DriveDescription base = model;
  std::erase_if(base.effects, [](const sim::EffectEntry& entry) { return !sim::find_effect(entry.kind)->base; });
  if (base.effects.size() == model.effects.size()) return {};
  std::vector<double> effort = inverse_effort(sim::Drive(model), motion);
  const std::vector<double> of_base = inverse_effort(sim::Drive(base), motion);
  for (std::size_t k = 0; k < effort.size(); ++k) effort[k] -= of_base[k];
  return ZeroPhaseLowPass::butterworth(motion.cutoff_Hz, motion.sample_rate_Hz)(effort);
}

std::optional<EffortTiming> found_timing(const Record& record, const sim::DriveDescription& model) {
  constexpr int kMostSteps = 8;
  constexpr double kSettled = 0.002;  // samples
  const sim::DataSheet& data = model.data;
  const sim::Drive drive(model);
  std::optional<Motion> motion = sliding_motion(record, data);
  if (!motion) return {};
  if (record.has_position()) take_off_encoder_error(drive, *motion);
  const std::vector<double> further = further_effort(model, *motion);
  const auto take_off = [&](std::vector<double>& effort) {
    for (std::size_t k = 0; k < further.size(); ++k) effort[k] -= further[k];
  };
  Record current;  // only the channels that the torque or force needs
  current.path = record.path;
  current.sample_period_s = record.sample_period_s;
  current.i_A = record.i_A;
  std::vector<Terms> terms = terms_of(*motion);
  std::vector<double> effort = motion->effort;
  take_off(effort);
  double own = kBelievedTiming.samples, variance = HUGE_VAL;
  for (int step = 0; step < kMostSteps; ++step) {
    const std::optional<Step> found = step_of(*motion, terms, effort);
    if (!found) return {};
    variance = found->variance;
    const double before = own;
    own = std::clamp(own + std::clamp(found->samples, -1.0, 1.0), kBelievedTiming.samples - kLargestTiming,
                     kBelievedTiming.samples + kLargestTiming);
    if (std::abs(own - before) < kSettled) break;
    write_timing(current, {own, 0.0});
    effort = delivered_effort(current, data, motion->cutoff_Hz, true, nullptr).effort;
    effort.erase(effort.begin(), effort.begin() + static_cast<std::ptrdiff_t>(kMotionMargin));
    effort.resize(motion->effort.size());
    take_off(effort);
  }
  if (std::abs(own - kBelievedTiming.samples) >= kLargestTiming) return {};
  const double prior = 1.0 / (kBelievedTiming.deviation * kBelievedTiming.deviation), information = 1.0 / variance;
  return EffortTiming{(information * own + prior * kBelievedTiming.samples) / (information + prior),
                      1.0 / std::sqrt(information + prior)};
}

EffortTiming common_timing(const std::vector<EffortTiming>& timings) {
  double information = 0.0, sum = 0.0;
  for (const EffortTiming& timing : timings) {
    if (timing.deviation == 0.0) return timing;  // known
    const double own = 1.0 / (timing.deviation * timing.deviation);
    information += own;
    sum += own * timing.samples;
  }
  if (information == 0.0) return {};
  EffortTiming common{sum / information, 1.0 / std::sqrt(information)};
  double scatter = 0.0;  // in standard deviations, squared
  for (const EffortTiming& timing : timings)
    scatter += std::pow((timing.samples - common.samples) / timing.deviation, 2);
  if (timings.size() > 1)
    common.deviation *= std::sqrt(std::max(1.0, scatter / (static_cast<double>(timings.size()) - 1.0)));
  return common;
}

}  // namespace

EffortTiming effort_timing_of(const Record& record) {
  const auto samples = record.header.find(kSamplesKey), deviation = record.header.find(kDeviationKey);
  if (!record.u_V.empty() || samples == record.header.end()) return {};
  const auto number = [&](const auto& entry) {
    const std::optional<double> value = parse_number(entry->second);
    if (!value || !std::isfinite(*value))
      throw Failure(ExitCode::bad_input, fmt::format("{}: # {}: {} is not a number; give samples after the row, or "
                                                     "leave the line out",
                                                     record.path, entry->first, entry->second));
    return *value;
  };
  return {number(samples), deviation == record.header.end() ? 0.0 : number(deviation)};
}

std::vector<double> acting_current(const Record& record) {
  const double early = EffortTiming{}.samples - effort_timing_of(record).samples;
  if (early == 0.0) return record.i_A;
  const auto last = static_cast<std::ptrdiff_t>(record.i_A.size()) - 1;
  const auto whole = static_cast<std::ptrdiff_t>(std::floor(early));
  const double p = early - static_cast<double>(whole);
  // Lagrange's cubic through four rows, whose gain stays near 1 up to the filters' cut-off. Halfway between two rows,
  // it loses 0.4 % of the amplitude at a tenth of the sampling rate; a straight line would lose 5 %.
  const std::array<double, 4> weights{-p * (p - 1.0) * (p - 2.0) / 6.0, (p + 1.0) * (p - 1.0) * (p - 2.0) / 2.0,
                                      -(p + 1.0) * p * (p - 2.0) / 2.0, (p + 1.0) * p * (p - 1.0) / 6.0};
  std::vector<double> current(record.i_A.size(), 0.0);
  for (std::ptrdiff_t k = 0; k <= last; ++k)
    for (std::ptrdiff_t n = 0; n < 4; ++n)
      current[static_cast<std::size_t>(k)] +=
          weights[static_cast<std::size_t>(n)] *
          record.i_A[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k + whole + n - 1, 0, last))];
  return current;
}

HeldCurrent held_current(const Record& record) {
  const double early = EffortTiming{}.samples - effort_timing_of(record).samples, whole = std::floor(early);
  const auto last = static_cast<std::ptrdiff_t>(record.i_A.size()) - 1, offset = static_cast<std::ptrdiff_t>(whole);
  HeldCurrent held{{}, 1.0 - (early - whole)};
  held.i_A.reserve(record.i_A.size() + 1);
  for (std::ptrdiff_t k = 0; k <= last + 1; ++k)
    held.i_A.push_back(record.i_A[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k + offset, 0, last))]);
  return held;
}

void settle_effort_timing(const std::vector<Record*>& records, const sim::DriveDescription& model) {
  std::vector<Record*> of_one_logger;
  std::vector<EffortTiming> found;
  for (Record* record : records) {
    const bool stated = record->header.contains(kSamplesKey) && !record->header.contains(kEstimatedKey);
    if (!record->u_V.empty() || record->i_A.empty() || stated) continue;
    of_one_logger.push_back(record);
    write_timing(*record, kBelievedTiming);
    if (const std::optional<EffortTiming> own = found_timing(*record, model)) found.push_back(*own);
  }
  const EffortTiming common = found.empty() ? kBelievedTiming : common_timing(found);
  for (Record* record : of_one_logger) write_timing(*record, common);
}

std::vector<Record> timed_beside(const sim::DriveDescription& model, const std::vector<const Record*>& records) {
  const auto is_estimated = [](const Record* record) { return record->header.contains(kEstimatedKey); };
  if (std::ranges::none_of(records, is_estimated)) return {};
  std::vector<Record> copies;
  for (const Record* record : records) copies.push_back(*record);
  std::vector<Record*> pointers;
  for (Record& copy : copies) pointers.push_back(&copy);
  settle_effort_timing(pointers, model);
  return copies;
}

bool timing_explains_delays(const std::vector<const Record*>& records) {
  return std::ranges::all_of(records, [](const Record* record) {
    return record->u_V.empty() && effort_timing_of(*record).deviation < kBelievedTiming.deviation;
  });
}

nlohmann::json effort_timing_json(const std::vector<const Record*>& records) {
  std::vector<EffortTiming> different;
  for (const Record* record : records)
    if (const EffortTiming timing = effort_timing_of(*record); std::ranges::find(different, timing) == different.end())
      different.push_back(timing);
  const EffortTiming common = common_timing(different);
  const double half = kNormal95 * common.deviation;
  return {{"samples", common.samples}, {"ci95", {common.samples - half, common.samples + half}}};
}

}  // namespace host
