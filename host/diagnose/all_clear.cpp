#include "host/diagnose/all_clear.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "host/diagnose/candidate_search.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/diagnose/visibility.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// Part of the squared residual that may depend on a coordinate. Of made cases without any effect it is below 0.05.
constexpr double kMostDependence = 0.1;
/// The same for the acceleration, whose changes the smoother rounds off: up to 0.61 in a hundred such drives.
constexpr double kMostOnAcceleration = 0.7;

/// Windows in which the axis neither stands nor turns over.
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

/// The error may exceed its size where single breakaways or impacts come a moment late: while the axis slides it is
/// small then, and so it is with those windows weighed down.
bool is_small(const sim::DriveDescription& model, const RecordSet& set) {
  const SetError error = error_of(sim::Drive(model), set);
  if (error.combined <= kSmall) return true;
  return error.robust <= 1.0 && error_while_sliding(model, set) <= 1.0;
}

/// The base fitted to both sets, where it suits both: then what a base of the training data alone leaves on validation
/// data is its own uncertainty (a viscous coefficient, say, from motions slower than those that judge).
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
  return {
      Status::insufficient_data,
      fmt::format("The error on validation data is {:.2f} times the floor, but fitted to both sets together the base "
                  "leaves {:.2f}: the training data leave {} too open to say what these motions should have been",
                  diagnosis.before_validate, error_of(sim::Drive(base), diagnosis.validation).combined,
                  moved.empty() ? "it" : fmt::format("{}", fmt::join(moved, ", "))),
      diagnosis.held_back ? "Record the same motions for longer."
                          : "Train on motions as fast, as slow and as lively as those that validate."};
}

/// What is left as something that depends on a coordinate; null where it depends on none.
const ResidualDependence* dependence_in(const ResidualTests& tests) {
  const auto depends = std::ranges::find_if(tests.dependences, [](const ResidualDependence& dependence) {
    return dependence.share > (dependence.coordinate == "acceleration" ? kMostOnAcceleration : kMostDependence);
  });
  return depends == tests.dependences.end() ? nullptr : &*depends;
}

/// Whether that goes with the base of both sets, as a residual in proportion to the acceleration does where the
/// training data hold few accelerations.
bool depends_on_base_alone(const Diagnosis& diagnosis) {
  const std::optional<sim::DriveDescription> base = base_of_both(diagnosis);
  return base && dependence_in(test_residuals(*base, diagnosis.training, diagnosis.validation)) == nullptr;
}

/// Effects whose trace no motion sets apart from this base: a constant from a Coulomb level by direction, an offset of
/// the tachometer from its noise, and what acts on static friction that the base does not have.
bool is_taken_up(const std::string& kind, const sim::DriveDescription& base) {
  constexpr std::array kConstants = {"constant_torque", "dac_offset", "coulomb_asymmetry", "tach_offset"};
  constexpr std::array kOfStaticFriction = {"friction_lag", "dwell_stiction"};
  const auto among = [&](const auto& kinds) { return std::ranges::find(kinds, kind) != kinds.end(); };
  return among(kConstants) || (base.find("stribeck") == nullptr && among(kOfStaticFriction));
}

std::string_view coordinate_of(std::string_view partition, std::string_view region) {
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
  // Of made cases without any effect it is below this, but for one in a hundred.
  constexpr double kLeast = 0.02;
  // The smoother alone leaves as much along the acceleration, so that it is named where nothing else shows.
  constexpr double kLeastOnAcceleration = 0.05;
  // Whatever depends on the motion also lasts from one moment to the next; and a program whose parts differ makes it
  // differ from one part of the record to another.
  constexpr double kLasting = 0.15, kSlow = 0.8;
  // After rests of one length there are more bins than over all speeds: what they add must be clear.
  constexpr double kAfterRests = 0.85;
  // What hardly depends on where it is found is a constant.
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
  // Of 27 machines with something that the catalogue lacked, bristles leave 0.87 of it there, friction that grows in
  // rests, which its own coordinate tells, 0.75, the others at most 0.58.
  constexpr double kWeak = 0.05, kNearReversals = 0.65;
  if (most < kWeak && tests.near_reversals > kNearReversals)
    return {"travel_since_reversal", tests.where_near_reversals};
  if (best != nullptr && tests.constant > kConstant * most)
    return {"speed", by_speed_channel ? "in the speed channel alone, at any speed alike" : "at any speed alike"};
  if (best == nullptr && on_acceleration != nullptr && on_acceleration->share >= kLeastOnAcceleration)
    best = on_acceleration;
  if (best != nullptr)
    return {best->coordinate, (by_speed_channel ? "in the speed channel alone, " : "") + best->where};
  if (const ErrorRegion* worst = worst_region(diagnosis.where))
    return {std::string(coordinate_of(worst->partition, worst->region)), worst->words};
  return {"time", "spread evenly over the records"};
}

std::optional<Objection> objection_to_claim(const Diagnosis& diagnosis) {
  if (diagnosis.rough || diagnosis.before_train >= 2.0 * kSmall) return {};  // what is missing shows in training alone
  if (const auto base = base_of_both(diagnosis)) return base_is_open(diagnosis, *base);
  return {};
}

std::optional<Objection> objection_to_all_clear(const Diagnosis& diagnosis, const ResidualTests& tests) {
  for (const auto& [set, name, error] : {std::tuple(&diagnosis.training, "training", diagnosis.before_train),
                                         std::tuple(&diagnosis.validation, "validation", diagnosis.before_validate)}) {
    if (is_small(diagnosis.base, *set)) continue;
    const double told = set == &diagnosis.validation ? diagnosis.told(error) : diagnosis.told_of_training(error);
    // Of few windows, a single bad one makes such an error.
    const auto windows = static_cast<double>(set->used_windows());
    if (error < kSmall * (1.0 + 1.0 / std::sqrt(windows)))
      return Objection{Status::insufficient_data,
                       fmt::format("The error on {} data is {:.2f} times the floor, more than a complete model leaves, "
                                   "but {:.0f} windows are too few to be sure of it",
                                   name, told, windows),
                       "Record the same motions for longer."};
    if (const auto base = base_of_both(diagnosis)) return base_is_open(diagnosis, *base);
    return Objection{Status::unexplained,
                     fmt::format("The error on {} data is {:.2f} times the floor, and no effect of the catalogue "
                                 "accounts for it",
                                 name, told),
                     "Look where the error lives, and record that motion alone, slowly and fast, both ways."};
  }
  const ResidualDependence* depends = dependence_in(tests);
  if (depends != nullptr && !depends_on_base_alone(diagnosis))
    return Objection{
        Status::unexplained,
        fmt::format("The error is small ({:.2f} times the floor), but what is left is no noise: {:.0f} % "
                    "of it depends on {}",
                    diagnosis.told(diagnosis.before_validate), 100.0 * depends->share, depends->coordinate),
        "Look where the error lives, and record that motion alone, slowly and fast, both ways."};
  std::vector<std::string> hidden, ways;
  for (const Visibility& effect : visibility_of_effects(diagnosis.base, diagnosis.training, diagnosis.validation)) {
    if (effect.floors >= kVisible || is_taken_up(effect.kind, diagnosis.base)) continue;
    if (std::ranges::find(diagnosis.absent, effect.kind) != diagnosis.absent.end()) continue;
    hidden.push_back(effect.kind);
    ways.emplace_back(sim::find_effect(effect.kind)->separate_by);
  }
  if (hidden.empty()) return {};
  return Objection{Status::insufficient_data,
                   fmt::format("What is left is noise ({:.2f} times the floor), but an effect of usual size that "
                               "these motions would not have shown may be there: {}",
                               diagnosis.told(diagnosis.before_validate), fmt::join(hidden, ", ")),
                   ways.front() + "."};
}

}  // namespace host
