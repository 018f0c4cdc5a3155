#include "host/identify/friction_identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "host/exit_codes.hpp"
#include "host/identify/encoder_step.hpp"
#include "host/identify/plausibility.hpp"
#include "host/record/record_origin.hpp"

namespace host {

namespace {

/// The observer of the design, with a variance for every sensor of the records. If the data sheet gives no encoder
/// resolution, the smallest step in the record is used.
AxisDesign observer_for(const std::vector<Record>& records, const sim::DriveDescription& model) {
  sim::DriveDescription seen = model;
  if (!std::ranges::all_of(records, &Record::has_speed)) seen.data.tach_noise_variance.reset();
  DesignOptions options;
  if (!(model.data.encoder_resolution > 0.0)) {
    constexpr double kUnknown = 1e-6;  // mm or m; without a position the observer is not used
    double step = 0.0;
    for (const Record& record : records) step = std::max(step, encoder_step(record, model.data));
    options.position_variance = (step > 0.0 ? step * step : kUnknown * kUnknown) / 12.0;
  }
  return design_axis(seen, options);
}

std::vector<CurvePoint> by_control_signal(const std::vector<FrictionPoint>& points) {
  std::vector<CurvePoint> curve;
  for (const FrictionPoint& point : points) {
    if (point.is_steady()) curve.push_back({point.speed, point.effort, point.standard_error});
  }
  return curve;
}

std::vector<CurvePoint> by_disturbance(const std::vector<FrictionPoint>& points, bool steady_only) {
  std::vector<CurvePoint> curve;
  for (const FrictionPoint& point : points) {
    if (point.is_steady() || !steady_only)
      curve.push_back({point.speed, point.observed_effort.value_or(0.0), point.standard_error});
  }
  return curve;
}

/// Writes the values of one direction in the form of the model file, in which those of the backward direction are
/// negative.
void put(sim::EffectEntry& entry, const std::string& id, const Estimate& estimate, bool forward, bool has_interval) {
  const double sign = forward ? 1.0 : -1.0;
  entry.parameters[id] = sign * estimate.value;
  if (!has_interval) return;
  const double a = sign * estimate.ci95[0], b = sign * estimate.ci95[1];
  entry.ci95[id] = {std::min(a, b), std::max(a, b)};
}

void replace_entry(sim::DriveDescription& model, sim::EffectEntry entry) {
  if (sim::EffectEntry* found = model.find(entry.kind)) {
    *found = std::move(entry);
  } else {
    model.effects.push_back(std::move(entry));
  }
}

sim::DriveDescription model_with(const sim::DriveDescription& before, const FrictionFit& fit, bool symmetric,
                                 bool has_interval, const std::string& from) {
  sim::DriveDescription model = before;
  sim::EffectEntry viscous{.kind = "viscous", .parameters = {}, .ci95 = {}, .from = from};
  sim::EffectEntry coulomb{.kind = "coulomb", .parameters = {}, .ci95 = {}, .from = from};
  sim::EffectEntry stribeck{.kind = "stribeck", .parameters = {}, .ci95 = {}, .from = from};
  put(viscous, "B", fit.viscous, true, has_interval);
  if (symmetric) {
    put(coulomb, "level", fit.coulomb[0], true, has_interval);
    put(stribeck, "static", fit.static_level[0], true, has_interval);
    put(stribeck, "omega1", fit.omega1[0], true, has_interval);
    put(stribeck, "omega2", fit.omega2[0], true, has_interval);
  } else {
    for (std::size_t d = 0; d < 2; ++d) {
      const bool forward = d == 0;
      const std::string direction = forward ? "positive" : "negative";
      put(coulomb, direction, fit.coulomb[d], forward, has_interval);
      put(stribeck, "static_" + direction, fit.static_level[d], forward, has_interval);
      put(stribeck, "omega1_" + direction, fit.omega1[d], forward, has_interval);
      put(stribeck, "omega2_" + direction, fit.omega2[d], forward, has_interval);
    }
  }
  replace_entry(model, std::move(viscous));
  replace_entry(model, std::move(coulomb));
  if (fit.has_stribeck) {
    replace_entry(model, std::move(stribeck));
  } else {
    std::erase_if(model.effects, [](const sim::EffectEntry& entry) { return entry.kind == "stribeck"; });
  }
  return model;
}

void cross_check(FrictionIdentification& result) {
  constexpr double kGainOff = 0.002;
  if (!result.tachometer) return;
  const Estimate& gain = result.tachometer->gain;
  if (std::abs(gain.value - 1.0) <= std::max(kGainOff, gain.half_width())) return;
  std::string text = fmt::format("the tachometer reads {:+.2f} % ± {:.2f} % against the encoder",
                                 100.0 * (gain.value - 1.0), 100.0 * gain.half_width());
  if (result.viscous_by_disturbance) {
    text += fmt::format("; B is {:.4g} from the Kalman disturbance and {:.4g} from the mean control signal",
                        result.viscous_by_disturbance->value, result.fit.viscous.value);
  }
  text +=
      result.method == FrictionMethod::joint
          ? ". The curve uses the control signal and the encoder and is not affected; re-scale the tachometer before "
            "using it for control"
          : ". The paper's procedure uses the uncorrected disturbance: re-scale the tachometer, or use --method joint";
  result.warnings.push_back(text);
}

/// A model with one level for both directions keeps that form. If the points contradict it, a warning says so.
void warn_of_unequal_directions(FrictionIdentification& result) {
  constexpr double kClearlyWorse = 2.0;
  const FrictionFit free = fit_friction(by_control_signal(result.points), false);
  if (result.fit.rms < kClearlyWorse * free.rms) return;
  result.warnings.push_back(fmt::format(
      "the model has one friction level for both directions, but the directions differ (residual {:.3g}, or {:.3g} "
      "with one level for each): possible causes are a constant torque, an offset of the converter, or friction that "
      "differs by direction. Give positive and negative levels, or ask axistool diagnose",
      result.fit.rms, free.rms));
}

void warn_of_other_effects(FrictionIdentification& result) {
  for (const char* kind :
       {"coulomb_asymmetry", "viscous_asymmetry", "nonlinear_viscous", "constant_torque", "dac_offset"}) {
    if (result.model.find(kind) == nullptr) continue;
    result.warnings.push_back(
        fmt::format("the model also has {}, which is now included in the friction curve as well. Remove it, or fit all "
                    "together with axistool improve",
                    kind));
  }
}

}  // namespace

std::string_view method_name(FrictionMethod method) { return method == FrictionMethod::joint ? "joint" : "paper"; }

FrictionMethod friction_method_named(std::string_view name) {
  for (const FrictionMethod method : {FrictionMethod::joint, FrictionMethod::paper})
    if (name == method_name(method)) return method;
  throw Failure(ExitCode::usage, fmt::format("--method: {} not in {{joint,paper}}", name));
}

FrictionIdentification identify_friction(const Measurements& measured, const sim::DriveDescription& model,
                                         FrictionMethod method, const ConstantSpeedOptions& options) {
  const std::vector<Record>& records = measured.training();
  FrictionIdentification result;
  result.method = method;
  const AxisDesign design = observer_for(records, model);
  result.observer_viscous = design.axis.viscous;
  result.tachometer = calibrate_tachometer(records, model.data);
  result.points = friction_points(records, model.data, design, options);
  const bool observed = std::ranges::all_of(records, &Record::has_position);
  const bool symmetric = method == FrictionMethod::joint && is_symmetric(model);
  if (method == FrictionMethod::paper) {
    if (!observed) {
      throw Failure(ExitCode::bad_input, "the paper's procedure needs a position (x_mm or x_m) in every record");
    }
    result.fit = fit_friction_as_paper(by_disturbance(result.points, false), design.axis.viscous);
  } else {
    result.fit = fit_friction(by_control_signal(result.points), symmetric);
    if (observed) result.viscous_by_disturbance = fit_friction(by_disturbance(result.points, true), symmetric).viscous;
    if (!result.fit.has_stribeck) {
      result.warnings.push_back(
          "the points show no static friction above the Coulomb level, so the model has no stribeck effect; to test "
          "for it, jog at five or more speeds in each direction, some far below 1 mm/s");
    }
  }
  result.model = model_with(model, result.fit, symmetric, method == FrictionMethod::joint, origin_of(records));
  cross_check(result);
  if (symmetric) warn_of_unequal_directions(result);
  warn_of_other_effects(result);
  std::ranges::copy(messages_of(doubts_of(result.model)), std::back_inserter(result.warnings));
  for (sim::EffectEntry& entry : result.model.effects) keep_within_bounds(entry, model.data.kind, result.warnings);
  return result;
}

}  // namespace host
