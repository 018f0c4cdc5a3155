#include "host/identify/identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "host/exit_codes.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/identify/plausibility.hpp"
#include "host/identify/zero_phase_filter.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/record_origin.hpp"
#include "host/statistics.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

void require_same_rate(const std::vector<Record>& records) {
  for (const Record& record : records) {
    if (std::abs(record.sample_period_s - records.front().sample_period_s) > 1e-6 * record.sample_period_s) {
      throw Failure(
          ExitCode::bad_input,
          fmt::format("{}: sampled every {:g} s but {} every {:g} s; this method stacks samples of one rate "
                      "(--method sliding-ls takes several; axistool import --resample makes them one)",
                      record.path, record.sample_period_s, records.front().path, records.front().sample_period_s));
    }
  }
}

void require_enough(const std::vector<Record>& records) {
  constexpr double kLowestRate_Hz = 50.0;  // five samples per period of the filters' lowest cut-off, 10 Hz
  constexpr double kShortest_s = 0.2;      // twice the required sliding in each direction
  for (const Record& record : records) {
    require_rate(record, kLowestRate_Hz, "see the axis accelerate");
    require_duration(record, kShortest_s, "hold a movement");
  }
}

void set_entry(sim::DriveDescription& model, const std::string& kind, const std::string& from,
               const std::vector<std::pair<std::string, Estimate>>& values) {
  sim::EffectEntry entry{.kind = kind, .parameters = {}, .ci95 = {}, .from = from};
  for (const auto& [id, estimate] : values) {
    entry.parameters[id] = estimate.value;
    entry.ci95[id] = estimate.ci95;
  }
  model.effects.push_back(std::move(entry));
}

/// One level for both directions from two levels, in the form of the drive's description.
Estimate common_level(const Estimate& positive, const Estimate& negative) {
  const double value = 0.5 * (positive.value - negative.value);
  const double half = 0.5 * std::hypot(positive.half_width(), negative.half_width());
  return {value, {value - half, value + half}};
}

sim::DriveDescription model_from(const sim::DriveDescription& drive, const RigidEstimate& estimate,
                                 const std::string& from) {
  sim::DriveDescription model;
  model.name = drive.name;
  model.data = drive.data;
  set_entry(model, "inertia", from, {{"J", estimate.inertia}});
  set_entry(model, "viscous", from, {{"B", estimate.viscous}});
  if (estimate.positive && estimate.negative) {
    const sim::EffectEntry* before = drive.find("coulomb");
    if (before != nullptr && before->has("level")) {
      set_entry(model, "coulomb", from, {{"level", common_level(*estimate.positive, *estimate.negative)}});
    } else {
      set_entry(model, "coulomb", from, {{"positive", *estimate.positive}, {"negative", *estimate.negative}});
    }
  }
  return model;
}

/// Corrects values that a model file must not contain, with a warning. If one Coulomb level has the wrong sign, an
/// offset is larger than the friction, and half of the difference between the levels is the friction.
void keep_to_the_physics(sim::DriveDescription& model, const RigidEstimate& estimate,
                         std::vector<std::string>& warnings) {
  for (sim::EffectEntry& entry : model.effects) {
    if (entry.kind == "inertia") continue;  // no other value could replace it
    const sim::EffectInfo& info = *sim::find_effect(entry.kind);
    const auto key = [&](const char* id) { return info.parameter(id)->key(model.data.kind); };
    if (entry.has("positive") && (entry.at("positive") < 0.0 || entry.at("negative") > 0.0)) {
      const Estimate level = common_level(*estimate.positive, *estimate.negative);
      entry.parameters = {{"level", level.value}};
      entry.ci95 = {{"level", level.ci95}};
      warnings.push_back(
          fmt::format("{} and {} differ too much for friction alone. The model uses their mean for both directions, {} "
                      "= {:.4g}; the rest is probably weight (constant_torque) or an offset (dac_offset)",
                      key("positive"), key("negative"), key("level"), std::max(0.0, level.value)));
    }
    keep_within_bounds(entry, model.data.kind, warnings);
  }
}

void warn_of_tachometer(Identification& result, bool corrected) {
  if (!result.tachometer) return;
  constexpr double kGainOff = 0.002;   // changes B by several per cent
  constexpr double kOffsetOff = 0.05;  // rad/s; a tenth of the paper's dead band
  const Estimate &gain = result.tachometer->gain, &offset = result.tachometer->offset;
  const bool gain_off = std::abs(gain.value - 1.0) > std::max(kGainOff, gain.half_width());
  const bool offset_off = result.model.data.kind == sim::DriveKind::rotary &&
                          std::abs(offset.value) > std::max(kOffsetOff, offset.half_width());
  if (!gain_off && !offset_off) return;
  result.warnings.push_back(fmt::format(
      "the tachometer disagrees with the encoder: gain {:.4f} ± {:.4f}, offset {:+.3g} ± {:.2g}; {}. Re-scale it, or "
      "add "
      "the effects tach_gain and tach_offset",
      gain.value, gain.half_width(), offset.value, offset.half_width(),
      corrected ? "corrected here before the estimate"
                : "the estimates use the uncorrected record and carry the error"));
}

void warn_of_amplifier(Identification& result) {
  if (!result.amplifier) return;
  const double sheet = result.model.data.amplifier_gain_A_per_V;
  constexpr double kGainOff = 0.01;
  const Estimate& gain = result.amplifier->gain;
  if (!(sheet > 0.0) || std::abs(gain.value - sheet) <= std::max(kGainOff * sheet, gain.half_width())) return;
  result.warnings.push_back(
      fmt::format("the current shows an amplifier gain of {:.4g} ± {:.2g} A/V, the data sheet says {:.4g}: inertia and "
                  "friction are off by {:+.1f} %. --gain current takes the measured one",
                  gain.value, gain.half_width(), sheet, 100.0 * (sheet / gain.value - 1.0)));
}

std::string dropped_effects(const sim::DriveDescription& drive) {
  std::string kinds;
  for (const sim::EffectEntry& entry : drive.effects) {
    if (entry.kind == "inertia" || entry.kind == "viscous" || entry.kind == "coulomb") continue;
    kinds += (kinds.empty() ? "" : ", ") + entry.kind;
  }
  return kinds;
}

/// Widens the intervals of an estimate by inverse models, `estimator`, for the uncertainty of the time offsets of the
/// torque or force. If offsets and parameters are estimated together, the covariance of the parameters is that for
/// known offsets plus, for each offset, its variance times the square of the sensitivity of the parameters to it.
template <typename Estimator>
void widen_by_timing(const std::vector<Record>& records, const std::vector<Motion>& motions, Estimator estimator,
                     RigidEstimate& estimate) {
  const auto widen = [](Estimate& one, double deviation) {
    const double half = std::hypot(one.half_width(), kNormal95 * deviation);
    one.ci95 = {one.value - half, one.value + half};
  };
  std::vector<EffortTiming> widened;
  for (const Record& record : records) {
    const EffortTiming timing = effort_timing_of(record);
    const double deviation = timing.deviation;
    if (!(deviation > 0.0) || std::ranges::find(widened, timing) != widened.end()) continue;
    widened.push_back(timing);
    std::vector<Motion> slopes = motions;  // change per sample, in the records that share this offset
    for (std::size_t other = 0; other < slopes.size(); ++other)
      slopes[other].effort = effort_timing_of(records[other]) == timing
                                 ? central_difference(motions[other].effort, 1.0)
                                 : std::vector<double>(motions[other].effort.size());
    const RigidEstimate change = estimator(slopes);
    widen(estimate.inertia, deviation * change.inertia.value);
    widen(estimate.viscous, deviation * change.viscous.value);
    if (estimate.positive && change.positive) widen(*estimate.positive, deviation * change.positive->value);
    if (estimate.negative && change.negative) widen(*estimate.negative, deviation * change.negative->value);
  }
}

/// The motions of the records, computed from one of the channels.
struct Attempt {
  MotionOptions options;
  std::vector<Motion> motions;
  ExcitationSummary excitation;
  RigidEstimate estimate;
  sim::DriveDescription model;
  double relative_error = 0.0;
  bool beside_travel = false;
};

/// The estimate with a curve over the travel, if that curve explains most of the residual of inertia and friction and
/// the inertia can still be identified. It cannot in a steady oscillation, in which the acceleration is proportional to
/// the position.
std::optional<RigidEstimate> estimate_beside_travel(const Attempt& made) {
  constexpr double kMostOfIt = 0.5;   // of the norm, so three quarters of the square
  constexpr double kKnown = 0.3;      // half of its interval, relative to the inertia
  constexpr double kSliding_s = 3.0;  // 30 blocks of 0.1 s for the twelve unknowns
  if (made.excitation.forward_s + made.excitation.backward_s < kSliding_s) return {};
  const RigidEstimate found = least_squares_beside_travel(made.motions);
  if (!(found.relative_residual < kMostOfIt * made.estimate.relative_residual) ||
      !(found.inertia.half_width() < kKnown * found.inertia.value) || !(found.condition_number < kPoorCondition))
    return {};
  return found;
}

}  // namespace

std::string_view method_name(IdentificationMethod method) {
  switch (method) {
    case IdentificationMethod::simple_ls:
      return "ls";
    case IdentificationMethod::unbiased_ls:
      return "unbiased-ls";
    case IdentificationMethod::sliding_ls:
      return "sliding-ls";
  }
  return "";
}

IdentificationMethod default_method(const std::vector<Record>& records) {
  const bool tachometer = std::ranges::all_of(records, &Record::has_speed);
  return tachometer ? IdentificationMethod::sliding_ls : IdentificationMethod::unbiased_ls;
}

IdentificationMethod method_named(std::string_view name, const std::vector<Record>& records) {
  using enum IdentificationMethod;
  if (name.empty()) return default_method(records);
  for (const auto method : {unbiased_ls, simple_ls, sliding_ls})
    if (name == method_name(method)) return method;
  throw Failure(ExitCode::usage, fmt::format("--method: {} not in {{unbiased-ls,ls,sliding-ls}}", name));
}

Identification identify_drive(const Measurements& measured, const sim::DriveDescription& drive,
                              IdentificationMethod method, const MotionOptions& options) {
  const std::vector<Record>& given = measured.training();
  if (given.empty()) throw Failure(ExitCode::usage, "no record was given");
  const bool tachometer = std::ranges::all_of(given, &Record::has_speed);
  const bool by_samples = tachometer && method != IdentificationMethod::sliding_ls;
  if (by_samples) require_same_rate(given);
  require_enough(given);
  Identification result;
  result.method = method;
  result.tachometer = calibrate_tachometer(given, drive.data);
  result.tach_noise_variance = standstill_variance(given, drive.data);
  result.amplifier = amplifier_gain(given, drive.data.dac_limit_V);
  std::vector<Record> records = given;
  const bool corrected = method == IdentificationMethod::sliding_ls && result.tachometer.has_value();
  if (corrected) apply_calibration(*result.tachometer, records);

  const Coulomb coulomb = method == IdentificationMethod::simple_ls ? Coulomb::left_out : Coulomb::estimated;
  const auto attempt = [&](bool by_speed) {
    Attempt made;
    made.options = options;
    made.options.by_speed = by_speed;
    if (!options.cutoff_Hz) made.options.cutoff_Hz = choose_cutoff(records, drive.data, by_speed);
    for (const Record& record : records) made.motions.push_back(prepare_motion(record, drive.data, made.options));
    made.excitation = summarise_excitation(records, made.motions, drive.data);
    require_motion(made.excitation, drive.data);
    made.estimate = by_samples ? discrete_least_squares(records, drive.data, made.motions.front().deadband, coulomb)
                               : inverse_least_squares(made.motions, coulomb);
    if (!by_samples && coulomb == Coulomb::estimated && std::ranges::all_of(records, &Record::has_position)) {
      if (const auto beside = estimate_beside_travel(made)) {
        made.estimate = *beside;
        made.beside_travel = true;
      }
    }
    if (!by_samples) {
      const auto again = [&](const std::vector<Motion>& motions) {
        return made.beside_travel ? least_squares_beside_travel(motions) : inverse_least_squares(motions, coulomb);
      };
      widen_by_timing(records, made.motions, again, made.estimate);
    }
    require_determined(made.estimate, made.excitation, drive.data);
    made.model = model_from(drive, made.estimate, origin_of(given));
    made.relative_error = relative_error(made.model, records, made.options);
    return made;
  };
  Attempt best = attempt(false);
  const bool positions = std::ranges::all_of(records, &Record::has_position);
  if (corrected && positions) {
    try {
      if (Attempt by_speed = attempt(true); by_speed.relative_error < kClearlyBetterBySpeed * best.relative_error)
        best = std::move(by_speed);
    } catch (const Failure&) {  // the speed channel alone does not determine the drive
    }
  }
  result.by_speed = best.options.by_speed || !positions;
  result.beside_travel = best.beside_travel;
  result.cutoff_Hz = best.motions.front().cutoff_Hz;
  result.decimation = best.motions.front().decimation;
  result.excitation = best.excitation;
  result.estimate = best.estimate;
  result.relative_error = best.relative_error;
  result.warnings = judge_estimate(result.estimate, result.excitation, drive.data);
  result.model = std::move(best.model);
  if (result.by_speed && positions)
    result.warnings.push_back(
        "the motion was taken from the speed channel, because the differentiated position is much noisier (jitter of "
        "the time stamps, coarse resolution)");
  if (result.tach_noise_variance && tachometer) result.model.data.tach_noise_variance = result.tach_noise_variance;
  if (result.beside_travel)
    result.warnings.push_back(
        "most of the torque or force beyond inertia and friction depends on position (gravity on an arm, a spring, "
        "cogging). A curve along the travel accounts for it in the fit, but is not in the model. axistool diagnose "
        "finds the cause");
  std::ranges::copy(messages_of(doubts_of(result.model)), std::back_inserter(result.warnings));
  keep_to_the_physics(result.model, result.estimate, result.warnings);
  warn_of_tachometer(result, corrected);
  warn_of_amplifier(result);
  if (const std::string kinds = dropped_effects(drive); !kinds.empty()) {
    result.warnings.push_back(fmt::format(
        "effects of the drive's file that this fit does not include were dropped: {}; add them again with axistool add",
        kinds));
  }
  return result;
}

}  // namespace host
