#include "host/diagnose/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/diagnose/all_clear.hpp"
#include "host/diagnose/claim.hpp"
#include "host/evidence/speed_coverage.hpp"
#include "host/known_by_current.hpp"
#include "host/report/text_format.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// A further effect must explain half of the explainable error that remains, and lower the error by 15 %. On a machine
/// limited by model error, the first is not required if the two effects need each other.
constexpr double kLeastFurtherShare = 0.5;
constexpr double kLeastFurtherGain = 0.15;
/// Relative change by which a base parameter counts as wrong.
constexpr double kMoved = 0.05;

/// The best candidate with `size` effects. One that helps only at a bound of its range is returned only if there is no
/// other.
const JudgedCandidate* best_of_size(const Diagnosis& diagnosis, std::size_t size) {
  const JudgedCandidate* best = nullptr;
  const auto is_better = [&](const JudgedCandidate& candidate) {
    if (best == nullptr || candidate.on_bound.empty() != best->on_bound.empty())
      return best == nullptr || candidate.on_bound.empty();
    return level_of_both(candidate.level) < level_of_both(best->level);
  };
  for (const JudgedCandidate& candidate : diagnosis.candidates)
    if (candidate.kinds.size() == size && is_better(candidate)) best = &candidate;
  return best;
}

bool earns_its_place(const JudgedCandidate& candidate, const Diagnosis& diagnosis) {
  return reservation_about(candidate, diagnosis) == Reservation::none;
}

/// Whether two effects together explain more than the sum of each alone, so that neither is found alone.
bool need_each_other(const JudgedCandidate& pair, const Diagnosis& diagnosis) {
  double alone = 0.0;
  for (const std::string& kind : pair.kinds) {
    const auto single = std::ranges::find(diagnosis.candidates, std::vector{kind}, &JudgedCandidate::kinds);
    if (single != diagnosis.candidates.end())  // else it gained too little and was not fitted further
      alone += explained_by(*single, diagnosis);
  }
  return explained_by(pair, diagnosis) > alone;
}

/// The effect that a candidate has instead of `kind`, if all others are equal; empty otherwise.
std::string exchanged_for(const std::string& kind, const JudgedCandidate& best, const JudgedCandidate& candidate) {
  if (candidate.kinds.size() != best.kinds.size()) return {};
  std::string other;
  for (const std::string& one : candidate.kinds) {
    if (one == kind) return {};
    if (std::ranges::find(best.kinds, one) != best.kinds.end()) continue;
    if (!other.empty()) return {};
    other = one;
  }
  return other;
}

/// Effects that can replace `kind`: they explain as much as the best candidate and are no more complicated.
std::vector<std::string> ties_of(const std::string& kind, const JudgedCandidate& best, const Diagnosis& diagnosis) {
  std::vector<std::string> tied;
  for (const JudgedCandidate& candidate : diagnosis.candidates) {
    const std::string other = exchanged_for(kind, best, candidate);
    if (other.empty() || !earns_its_place(candidate, diagnosis)) continue;
    if (level_of_both(candidate.level) > (1.0 + kTie) * level_of_both(best.level)) continue;
    if (parameters_of(candidate) > parameters_of(best)) continue;
    tied.push_back(other);
  }
  return tied;
}

/// Without constant speeds, nonlinear viscous friction may be Stribeck friction, and a fit of one form does not lead to
/// the other. An exponent above kSteepens is fluid drag.
bool may_be_stribeck(const JudgedCandidate& chosen, const Diagnosis& diagnosis) {
  constexpr double kSteepens = 1.5;
  const sim::EffectEntry* bend = chosen.model.find("nonlinear_viscous");
  if (bend != nullptr && bend->has("exponent") && bend->at("exponent") > kSteepens) return false;
  return chosen.kinds == std::vector<std::string>{"nonlinear_viscous"} && diagnosis.base.find("stribeck") == nullptr &&
         std::ranges::find(diagnosis.absent, "stribeck") == diagnosis.absent.end();
}

/// The simplest of the single effects that are as good as the best one.
const JudgedCandidate* simplest_near(const JudgedCandidate* best, const Diagnosis& diagnosis) {
  constexpr double kNear = 0.02;
  const JudgedCandidate* simplest = best;
  for (const JudgedCandidate& candidate : diagnosis.candidates)
    if (candidate.kinds.size() == 1 && candidate.level.validate <= (1.0 + kNear) * best->level.validate &&
        candidate.level.train <= (1.0 + kNear) * best->level.train &&
        parameters_of(candidate) < parameters_of(*simplest))
      simplest = &candidate;
  return simplest;
}

std::string heading_of(const std::string& kind) { return std::string(sim::find_effect(kind)->title); }

std::string parameters_in_words(const sim::EffectEntry& entry, sim::DriveKind kind) {
  std::vector<std::string> parts;
  for (const auto& [id, value] : entry.parameters)
    parts.push_back(fmt::format("{} = {:.4g}", sim::find_effect(entry.kind)->parameter(id)->key(kind), value));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// A ripple along the travel that alone lowers the training error but not the validation error. With an incremental
/// encoder each homing gives the travel a new zero and the ripple a new phase. Empty if there is no such ripple.
std::string ripple_that_does_not_transfer(const Diagnosis& diagnosis, sim::DriveKind kind) {
  for (const JudgedCandidate& candidate : diagnosis.candidates) {
    const sim::EffectEntry* last = candidate.model.find(candidate.kinds.back());
    if (last == nullptr || !last->has("period")) continue;
    double train = diagnosis.before_train, validate = diagnosis.before_validate;
    PrintedError printed = diagnosis.printed_base();
    if (candidate.kinds.size() == 2) {
      const auto first =
          std::ranges::find(diagnosis.candidates, std::vector{candidate.kinds.front()}, &JudgedCandidate::kinds);
      if (first == diagnosis.candidates.end()) continue;
      train = first->train_after;
      validate = first->after;
      printed = Diagnosis::printed(*first);
    }
    if (candidate.train_after > (1.0 - kLeastGain) * train || candidate.after < validate) continue;
    const double period_mm = kind == sim::DriveKind::rotary ? last->at("period") : 1e3 * last->at("period");
    return fmt::format(
        " A ripple every {:.4g} mm of travel ({}) lowers the error on training data from {:.2f} to {:.2f} times the "
        "noise floor, but not on validation data: its phase differs between records, as after a new homing, so it is "
        "not claimed.",
        period_mm, last->kind, printed.train, Diagnosis::printed(candidate).train);
  }
  return {};
}

double validation_s(const Diagnosis& diagnosis) {
  return static_cast<double>(diagnosis.validation.used_windows()) * diagnosis.window_s;
}

/// Why the best candidate is not claimed, as the end of a sentence about the error.
std::string reservation_in_words(const JudgedCandidate& closest, const Diagnosis& diagnosis) {
  const std::string what =
      fmt::format("; the best candidate, {}, leaves {:.2f} (training: {:.2f})", fmt::join(closest.kinds, " + "),
                  Diagnosis::printed(closest).validate, Diagnosis::printed(closest).train);
  switch (reservation_about(closest, diagnosis)) {
    case Reservation::none:
      return {};
    case Reservation::no_gain:
      return what;
    case Reservation::on_bound:
      return what + fmt::format(", but only with {} at a bound of its range", fmt::join(closest.on_bound, ", "));
    case Reservation::luck:
      return what + fmt::format(", which may be chance: {} candidates were tried on {:.1f} s of validation data",
                                diagnosis.tried, validation_s(diagnosis));
    case Reservation::leaves_much:
      return what +
             ". The true cause would bring the error close to 1, so this effect is probably standing in for another";
  }
  return {};
}

/// "61.01", and what compare prints for the given model if the refitted base differs from it.
std::string error_before(const sim::DriveDescription& given, const Diagnosis& diagnosis) {
  constexpr double kSame = 0.05;
  const double refitted = diagnosis.printed_base().validate;
  std::string text = fmt::format("{:.2f}", refitted);
  if (!diagnosis.judged_as_compared()) return text;
  const double as_given = diagnosis.rows.error_of(given).validate.combined;
  if (std::abs(as_given - refitted) > kSame * refitted)
    text += fmt::format(" (base refitted; {:.2f} as given)", as_given);
  return text;
}

}  // namespace

bool has_moved(const sim::EffectEntry& before, const sim::EffectEntry& after) {
  return std::ranges::any_of(before.parameters, [&](const auto& parameter) {
    const auto& [id, value] = parameter;
    return !after.has(id) || std::abs(after.at(id) - value) > kMoved * std::abs(value);
  });
}

std::vector<std::string> moved_parameters(const sim::DriveDescription& given, const sim::DriveDescription& base) {
  std::vector<std::string> moved;
  for (const char* kind : {"inertia", "viscous", "coulomb"}) {
    const sim::EffectEntry* before = given.find(kind);
    const sim::EffectEntry* after = base.find(kind);
    if (before != nullptr && after != nullptr && has_moved(*before, *after)) moved.emplace_back(kind);
  }
  return moved;
}

DiagnosisVerdict insufficient_data(const sim::DriveDescription& model, const PreparedSets& sets) {
  DiagnosisVerdict verdict;
  verdict.status = Status::insufficient_data;
  verdict.next_experiment = fmt::format(
      "Record {:.1f} s more of motion{}: steps in both directions well above static friction{}, and jogs at several "
      "speeds in both directions.",
      std::max(0.1, missing_motion_s(sets)), sets.held_back ? ", or a record of another motion for --validate" : "",
      is_known_by_current(model.data) ? std::string() : fmt::format(" (up to {:g} V)", 0.5 * model.data.dac_limit_V));
  verdict.explanation = fmt::format(
      "The axis moved for {:.2f} s in the training data and for {:.2f} s in {}: {} and {} independent windows. At "
      "least {} and {} are needed to separate inertia, friction and other effects.",
      sets.moving_train_s, sets.moving_validate_s, sets.held_back ? "the held-back part" : "the validation data",
      independent_windows(sets.moving_train_s), independent_windows(sets.moving_validate_s), kFewestToLearn,
      kFewestToJudge);
  return verdict;
}

DiagnosisVerdict reach_verdict(const sim::DriveDescription& given, const Diagnosis& diagnosis) {
  DiagnosisVerdict verdict;
  verdict.parameters = moved_parameters(given, diagnosis.base);
  const JudgedCandidate* single = best_of_size(diagnosis, 1);
  const JudgedCandidate* pair = best_of_size(diagnosis, 2);
  if (single != nullptr) single = simplest_near(single, diagnosis);
  const JudgedCandidate* triple = best_of_size(diagnosis, 3);
  const auto gains = [](const JudgedCandidate& more, const JudgedCandidate& less) {
    return is_better(more, less, kLeastFurtherGain);
  };
  const auto explains_enough = [](const JudgedCandidate& more, const JudgedCandidate& less) {
    return explained_beyond(less, more) >= kLeastFurtherShare;
  };
  const bool pair_stands = pair != nullptr && single != nullptr && earns_its_place(*pair, diagnosis) &&
                           gains(*pair, *single) &&
                           (explains_enough(*pair, *single) || (diagnosis.rough && need_each_other(*pair, diagnosis)));
  const bool triple_stands = triple != nullptr && pair != nullptr && earns_its_place(*triple, diagnosis) &&
                             gains(*triple, *pair) && explains_enough(*triple, *pair);
  const JudgedCandidate* chosen = triple_stands ? triple : pair_stands ? pair : single;
  const double before = diagnosis.printed_base().validate;

  if (chosen != nullptr && earns_its_place(*chosen, diagnosis)) {
    if (const std::optional<Objection> objection = objection_to_claim(diagnosis)) {
      verdict.status = objection->status;
      verdict.explanation = objection->explanation + ".";
      verdict.next_experiment = objection->next_experiment;
      return verdict;
    }
    verdict.effects = chosen->kinds;
    verdict.status = Status::missing;
    const sim::EffectInfo& first = *sim::find_effect(chosen->kinds.front());
    const auto gap = widest_speed_gap(prepared_records(diagnosis.training), given.data);
    for (const std::string& kind : chosen->kinds) {
      std::vector<std::string> group = ties_of(kind, *chosen, diagnosis);
      if (gap && may_be_stribeck(*chosen, diagnosis) && std::ranges::find(group, "stribeck") == group.end())
        group.emplace_back("stribeck");
      if (group.empty()) continue;
      group.insert(group.begin(), kind);
      verdict.alternatives.push_back(std::move(group));
    }
    if (chosen->kinds.size() == 1 && !verdict.alternatives.empty()) {
      verdict.status = Status::ambiguous;
      verdict.effects = verdict.alternatives.front();
    }
    std::vector<std::string> titles;
    for (const std::string& kind : chosen->kinds) titles.push_back(heading_of(kind));
    verdict.next_experiment = std::string(first.separate_by) + ".";
    const bool shapes_friction = std::ranges::any_of(
        chosen->kinds, [](const std::string& kind) { return sim::find_effect(kind)->stage == sim::Stage::friction; });
    if (shapes_friction && gap) verdict.next_experiment += " " + speeds_to_record(*gap);
    verdict.explanation = fmt::format(
        "{} ({}) lowers the error on validation data from {} to {:.2f} times the noise floor: {:.0f} % of the "
        "explainable error. {}.",
        fmt::join(titles, " and "), parameters_in_words(*chosen->model.find(chosen->kinds.back()), given.data.kind),
        error_before(given, diagnosis), Diagnosis::printed(*chosen).validate, 100.0 * explained_by(*chosen, diagnosis),
        first.shows);
    for (const std::vector<std::string>& group : verdict.alternatives)
      verdict.explanation += fmt::format(" These data cannot tell {} apart.", fmt::join(group, ", "));
    if (diagnosis.rough)
      verdict.explanation += fmt::format(
          " Every candidate leaves much more than noise, so the model is judged {}, before the error accumulates to a "
          "drift.",
          diagnosis.measure == Measure::effort ? std::string("by the torque or force of the measured motion")
                                               : fmt::format("over windows of {:g} s", diagnosis.window_s));
    if (chosen->after > kExplained) verdict.explanation += ripple_that_does_not_transfer(diagnosis, given.data.kind);
    return verdict;
  }
  const std::string closest = chosen == nullptr ? std::string() : reservation_in_words(*chosen, diagnosis);
  if (chosen != nullptr && reservation_about(*chosen, diagnosis) == Reservation::luck) {
    verdict.status = Status::insufficient_data;
    verdict.explanation =
        fmt::format("The error on validation data is {:.2f} times the noise floor{}.", before, closest);
    verdict.next_experiment = fmt::format(
        "Record longer: with so few data the best of {} candidates may win by chance. {:.1f} s of validation data in "
        "continuous motion can decide (four times as much in total if they are held back).",
        diagnosis.tried, std::max(2.0 * validation_s(diagnosis), least_validation_s(diagnosis.tried)));
    return verdict;
  }
  if (const std::optional<Objection> objection = objection_to_all_clear(diagnosis)) {
    verdict.status = objection->status;
    verdict.explanation = objection->explanation + closest + ".";
    if (objection->status == Status::unexplained) {
      const Trace trace =
          strongest_trace(diagnosis, test_residuals(diagnosis.base, diagnosis.training, diagnosis.validation));
      verdict.coordinate = trace.coordinate;
      verdict.where = trace.where;
      verdict.explanation += fmt::format(" The residual depends most on {}: {}. By motion, {}.",
                                         spaced(trace.coordinate), trace.where, where_it_fails(diagnosis.where));
      verdict.explanation += ripple_that_does_not_transfer(diagnosis, given.data.kind);
    }
    verdict.next_experiment = objection->next_experiment;
    return verdict;
  }
  verdict.status = verdict.parameters.empty() ? Status::adequate : Status::parameters;
  verdict.explanation = verdict.parameters.empty() ? fmt::format(
                                                         "The error is {:.2f} times the noise floor on validation "
                                                         "data; no known effect lowers it significantly.",
                                                         before)
                                                   : fmt::format(
                                                         "After refitting {} the error is {:.2f} times the noise floor "
                                                         "on validation data; no known effect lowers it significantly.",
                                                         fmt::join(verdict.parameters, ", "), before);
  verdict.next_experiment = "None needed for motions like these.";
  return verdict;
}

std::string_view status_name(Status status) {
  switch (status) {
    case Status::missing:
      return "missing";
    case Status::adequate:
      return "adequate";
    case Status::parameters:
      return "parameters";
    case Status::ambiguous:
      return "ambiguous";
    case Status::unexplained:
      return "unexplained";
    case Status::insufficient_data:
      return "insufficient_data";
  }
  return "";
}

}  // namespace host
