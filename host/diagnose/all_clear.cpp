#include "host/diagnose/all_clear.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "host/diagnose/verdict.hpp"
#include "host/diagnose/visibility.hpp"
#include "host/fit/base_fit.hpp"
#include "host/search/candidate_search.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// Error over the windows in which the axis moves without reversal.
double error_while_sliding(const sim::DriveDescription& model, const RecordSet& set) {
  const SetError error = error_of(sim::Drive(model), set);
  double square = 0.0;
  std::size_t channels = 0;
  for (const WindowScore& score : error.windows) {
    const PreparedRecord& prepared = set.records[score.record].prepared;
    const SmoothedMotion& motion = prepared.motion();
    const Window& window = prepared.windows[score.window];
    bool slides = true;
    for (std::size_t row = window.begin; row < window.begin + window.length && slides; ++row)
      slides = motion.w[row] * motion.w[row + 1] > 0.0 && !motion.standing[row];
    if (!slides) continue;
    for (const double part : {score.x, score.w, score.effort}) {
      square += part;
      if (part > 0.0) ++channels;
    }
  }
  return channels == 0 ? error.combined : std::sqrt(square / static_cast<double>(channels));
}

/// A few late breakaways or impacts may raise the total error above the limit. The error in sliding motion and the
/// robust error stay small even then.
bool is_small(const sim::DriveDescription& model, const RecordSet& set) {
  const SetError error = error_of(sim::Drive(model), set);
  if (error.combined <= kSmall) return true;
  return error.robust <= 1.0 && error_while_sliding(model, set) <= 1.0;
}

/// The base fitted to both sets, if it then fits both. If so, the validation error of a base fitted to the training
/// data alone only shows uncertain parameters (for example a viscous coefficient from slower motions).
std::optional<sim::DriveDescription> base_of_both(const Diagnosis& diagnosis) {
  sim::DriveDescription base = fit_base(diagnosis.base, together(diagnosis.training, diagnosis.validation));
  if (!is_small(base, diagnosis.training) || !is_small(base, diagnosis.validation)) return {};
  return base;
}

Objection base_is_open(const Diagnosis& diagnosis, const sim::DriveDescription& base) {
  std::vector<std::string> moved;
  for (const sim::EffectEntry& entry : diagnosis.base.effects)
    if (const sim::EffectEntry* other = base.find(entry.kind); other != nullptr && has_moved(entry, *other))
      moved.push_back(entry.kind);
  return {Status::insufficient_data,
          fmt::format(
              "The error on validation data is {:.2f} times the noise floor, but {:.2f} if the base model is fitted to "
              "both sets: the training data do not determine {} well enough to predict the validation motions",
              diagnosis.before_validate, error_of(sim::Drive(base), diagnosis.validation).combined,
              moved.empty() ? "it" : fmt::format("{}", fmt::join(moved, ", "))),
          diagnosis.held_back
              ? "Record the same motions for longer."
              : "Train on motions with the same range of speed and acceleration as the validation motions."};
}

/// Effects that no motion can separate from this base: a constant torque from Coulomb levels by direction, an offset of
/// the tachometer from its noise, and effects of static friction if the base has none.
bool is_taken_up(const std::string& kind, const sim::DriveDescription& base) {
  constexpr std::array kConstants = {"constant_torque", "dac_offset", "coulomb_asymmetry", "tach_offset"};
  constexpr std::array kOfStaticFriction = {"friction_lag", "dwell_stiction"};
  const auto among = [&](const auto& kinds) { return std::ranges::find(kinds, kind) != kinds.end(); };
  return among(kConstants) || (base.find("stribeck") == nullptr && among(kOfStaticFriction));
}

std::string_view region_coordinate(std::string_view partition, std::string_view region) {
  if (region == "reversal") return "travel_since_reversal";
  if (region == "acceleration" || region == "braking") return "acceleration";
  if (partition == "position" || partition == "place" || partition == "order") return "position";
  if (partition == "time" || partition == "event") return "time";
  if (partition == "rest") return "rest";
  if (partition == "frequency") return "frequency";
  return "speed";
}

}  // namespace

bool speed_channel_alone_fails(const Diagnosis& diagnosis) {
  constexpr double kClearlyWorse = 1.5;
  const SetError error = error_of(sim::Drive(diagnosis.base), diagnosis.validation);
  if (!(error.x_floor > 0.0) || !(error.w_floor > 0.0)) return false;
  return error.w_rms / error.w_floor > kClearlyWorse * std::max(1.0, error.x_rms / error.x_floor);
}

Trace strongest_trace(const Diagnosis& diagnosis, const ResidualTests& of_motion) {
  const bool by_speed_channel = speed_channel_alone_fails(diagnosis);
  const ResidualTests tests =
      by_speed_channel ? test_speed_channel(diagnosis.base, diagnosis.training, diagnosis.validation) : of_motion;
  // 99 of 100 simulated cases without an effect stay below this.
  constexpr double kLeast = 0.02;
  // The smoother rounds steps of the acceleration. This alone makes up to 0.61 of the squared residual depend on
  // acceleration (in a hundred drives without an effect). Below kMostOnAcceleration, acceleration is named only if no
  // other coordinate is.
  constexpr double kLeastOnAcceleration = 0.05, kMostOnAcceleration = 0.7;
  // A residual that depends on motion is also correlated in time, and differs between parts of the record if the
  // motions do.
  constexpr double kLasting = 0.15, kSlow = 0.8;
  // The partition by rest has more bins than that by speed, so its gain must be clear.
  constexpr double kAfterRests = 0.85;
  // A residual that hardly depends on the coordinate is a constant.
  constexpr double kConstant = 0.7;
  const ResidualDependence *best = nullptr, *on_acceleration = nullptr;
  double most = kLeast;
  for (const ResidualDependence& dependence : tests.dependences) {
    if (dependence.coordinate == "acceleration") {
      on_acceleration = &dependence;
      if (dependence.share < kMostOnAcceleration) continue;
    }
    const double weight =
        dependence.coordinate == "time"   ? std::max(kLasting * dependence.share, kSlow * dependence.in_detail)
        : dependence.coordinate == "rest" ? std::max(dependence.share, kAfterRests * dependence.in_detail)
                                          : std::max(dependence.share, dependence.in_detail);
    if (weight < most) continue;
    most = weight;
    best = &dependence;
  }
  // Share of the residual near reversals, in 27 machines with an effect outside the catalogue: presliding 0.87,
  // friction growing at rest 0.75 (named by its own coordinate), all others at most 0.58.
  constexpr double kWeak = 0.05, kNearReversals = 0.65;
  if (most < kWeak && tests.near_reversals > kNearReversals)
    return {"travel_since_reversal", tests.where_near_reversals};
  if (best != nullptr && tests.constant > kConstant * most)
    return {"speed", by_speed_channel ? "only in the speed channel, equally at all speeds" : "equally at all speeds"};
  if (best == nullptr && on_acceleration != nullptr && on_acceleration->share >= kLeastOnAcceleration)
    best = on_acceleration;
  if (best != nullptr) return {best->coordinate, (by_speed_channel ? "only in the speed channel, " : "") + best->where};
  if (const ErrorRegion* worst = worst_region(diagnosis.where))
    return {std::string(region_coordinate(worst->partition, worst->region)), worst->words};
  return {"time", "spread evenly over the records"};
}

std::optional<Objection> objection_to_claim(const Diagnosis& diagnosis) {
  if (diagnosis.rough || diagnosis.before_train >= 2.0 * kSmall) return {};  // the training data suffice
  if (const auto base = base_of_both(diagnosis)) return base_is_open(diagnosis, *base);
  return {};
}

std::optional<Objection> objection_to_all_clear(const Diagnosis& diagnosis) {
  const PrintedError printed = diagnosis.printed_base();
  for (const auto& [set, name, error, told] :
       {std::tuple(&diagnosis.training, "training", diagnosis.before_train, printed.train),
        std::tuple(&diagnosis.validation, "validation", diagnosis.before_validate, printed.validate)}) {
    if (is_small(diagnosis.base, *set)) continue;
    // With few windows, a single bad window can cause such an error.
    const auto windows = static_cast<double>(set->used_windows());
    if (error < kSmall * (1.0 + 1.0 / std::sqrt(windows)))
      return Objection{Status::insufficient_data,
                       fmt::format("The error on {} data is {:.2f} times the noise floor, more than a complete model "
                                   "would leave, but {:.0f} windows are too few to be certain",
                                   name, told, windows),
                       "Record the same motions for longer."};
    if (const auto base = base_of_both(diagnosis)) return base_is_open(diagnosis, *base);
    return Objection{
        Status::unexplained,
        fmt::format("The error on {} data is {:.2f} times the noise floor, and no known effect explains it", name,
                    told),
        "Find the motion with the largest error and record only that, slowly and fast, in both directions."};
  }
  std::vector<std::string> hidden, ways;
  for (const Visibility& effect : visibility_of_effects(diagnosis.base, diagnosis.training, diagnosis.validation)) {
    if (effect.floors >= kVisible || is_taken_up(effect.kind, diagnosis.base)) continue;
    if (std::ranges::find(diagnosis.absent, effect.kind) != diagnosis.absent.end()) continue;
    hidden.push_back(effect.kind);
    ways.emplace_back(sim::find_effect(effect.kind)->separate_by);
  }
  if (hidden.empty()) return {};
  return Objection{Status::insufficient_data,
                   fmt::format("The residual is noise ({:.2f} times the noise floor), but these motions would not show "
                               "the following effects at their usual size: {}",
                               printed.validate, fmt::join(hidden, ", ")),
                   ways.front() + "."};
}

}  // namespace host
