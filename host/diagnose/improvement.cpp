#include "host/diagnose/improvement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "host/cancellation.hpp"
#include "host/compare/chance.hpp"
#include "host/diagnose/certainty.hpp"
#include "host/diagnose/claim.hpp"
#include "host/diagnose/effect_by_motion.hpp"
#include "host/diagnose/effort_diagnosis.hpp"
#include "host/diagnose/judgement.hpp"
#include "host/effort/effort_terms.hpp"
#include "host/effort/free_curve_fit.hpp"
#include "host/evidence/measured_sensors.hpp"
#include "host/exit_codes.hpp"
#include "host/statistics.hpp"
#include "sim/catalogue.hpp"
#include "sim/curve.hpp"

namespace host {

namespace {

Rung rung_of(const Diagnosis& diagnosis, bool after, const std::vector<std::string>& added) {
  Rung rung;
  rung.added = added;
  rung.error = after ? diagnosis.best_error : diagnosis.base_error;
  if (diagnosis.judged_as_compared()) {
    rung.train = rung.error.train.combined;
    rung.validate = rung.error.validate.combined;
  } else {
    rung.train = after ? diagnosis.after_train : diagnosis.before_train;
    rung.validate = after ? diagnosis.after_validate : diagnosis.before_validate;
  }
  return rung;
}

/// A candidate of the search by motion that significantly halves the remaining squared error on both sets: too little
/// for a claim, but worth compensating. Null if there is none.
const JudgedCandidate* halves_the_rest(const Diagnosis& diagnosis) {
  constexpr double kHalf = 0.707;
  const JudgedCandidate* found = nullptr;
  for (const JudgedCandidate& tried : diagnosis.candidates) {
    if (!tried.on_bound.empty() || tried.luck > kMostLuck || tried.confidence < kClaimed) continue;
    if (tried.train_after > kHalf * diagnosis.before_train || tried.after > kHalf * tried.before) continue;
    if (found == nullptr || tried.after < found->after) found = &tried;
  }
  return found;
}

Rung rung_of(const Diagnosis& diagnosis, const JudgedCandidate& candidate) {
  const PrintedError printed = Diagnosis::printed(candidate);
  return {candidate.kinds, printed.train, printed.validate,
          candidate.error ? *candidate.error : diagnosis.rows.error_of(candidate.model)};
}

/// The steps of the regression, which added effects one by one against one noise floor until none was significant.
void append_effort_ladder(const Diagnosis& diagnosis, Improvement& result) {
  const EffortScreen& screen = *diagnosis.screen;
  std::size_t known = 0;
  const auto append = [&](const ScreenedModel& step) {
    Rung rung = rung_of(diagnosis, true, {step.kinds.begin() + static_cast<std::ptrdiff_t>(known), step.kinds.end()});
    known = step.kinds.size();
    rung.train = over_noise(screen, step, false);
    rung.validate = over_noise(screen, step, true);
    rung.error = diagnosis.rows.error_of(step.model);
    result.ladder.push_back(std::move(rung));
    result.model = step.model;
  };
  for (const ScreenedModel& step : screen.chosen) append(step);
  result.stopped_because = "no further effect explains enough of the remaining torque or force";
}

/// A fit to the motion, starting from another fit.
sim::DriveDescription fitted_to_motion(const sim::DriveDescription& model, const FigureRows& rows) {
  RecordSet training = figure_set(model, rows.train, kWindow_s);
  renew_floors(training, model);
  sim::DriveDescription fitted = fit_model(model, training).model;
  document_fit(fitted, training);
  return fitted;
}

/// The effects of a model on the inertia and friction of another: a noisy acceleration biases those of a force balance,
/// and no fit to the motion recovers from there.
sim::DriveDescription on_base_of(const sim::DriveDescription& given, sim::DriveDescription model) {
  for (sim::EffectEntry& entry : model.effects)
    if (const sim::EffectEntry* original = given.find(entry.kind);
        original != nullptr && sim::find_effect(entry.kind)->base)
      entry = *original;
  return model;
}

/// " (0.212 against 0.208 mm in x_mm)" of the channel that is farthest above its floor: noise floors differ by model,
/// RMS errors do not.
std::string in_words(const ErrorFigures& error, const ErrorFigures& given) {
  const ChannelFigures* worst = error.worst();
  if (worst == nullptr) return {};
  const auto before = std::ranges::find(given.channels, worst->name, &ChannelFigures::name);
  if (before == given.channels.end()) return {};
  return fmt::format(" ({:.4g} against {:.4g} {} in {})", worst->rms, before->rms, worst->unit, worst->name);
}

/// Never returns a model that predicts held-back records worse than the given one. A model fitted to torque or force is
/// first refitted to the motion.
void keep_the_better(Improvement& result, const sim::DriveDescription& given) {
  // A smaller change by a refit is neither an improvement nor a failure.
  constexpr double kNothing = 0.02;
  const ErrorOnSets& before = result.first.given_error;
  if (!is_worse(result.error.validate, before.validate)) return;
  if (result.first.moves_enough && !result.first.judged_as_compared()) {
    for (const sim::DriveDescription& start : {result.model, on_base_of(given, result.model)}) {
      const sim::DriveDescription fitted = fitted_to_motion(start, result.first.rows);
      const ErrorOnSets error = result.first.rows.error_of(fitted);
      if (is_worse(error.validate, before.validate)) continue;
      result.model = fitted;
      result.error = error;
      return;
    }
  }
  result.kept_given = true;
  result.is_refused =
      result.ladder.size() > 1 || result.error.validate.combined > (1.0 + kNothing) * before.validate.combined;
  result.stopped_because +=
      fmt::format("; the result predicts held-back records worse than the given model{}, so that is kept",
                  in_words(result.error.validate, before.validate));
  result.model = given;
  result.error = before;
}

}  // namespace

std::vector<ParameterEstimate> document_fit(sim::DriveDescription& model, const RecordSet& training) {
  std::vector<std::string> names;
  for (const ComparedRecord& compared : training.records) names.push_back(compared.prepared.record->path);
  for (sim::EffectEntry& entry : model.effects) entry.from = fmt::format("{}", fmt::join(names, " "));
  return estimate_intervals(model, training);
}

Improvement improve(const sim::DriveDescription& model, const Measurements& measured, const ShareDone& progress,
                    const std::vector<std::string>& absent, std::optional<Diagnosis> known, int most_rungs) {
  Improvement result;
  sim::DriveDescription current = model;
  for (int step = 0; step < most_rungs; ++step) {
    const auto part = [&](double share) {
      if (progress) progress((step + share) / (step + 2.0));
    };
    Diagnosis diagnosis = step == 0 && known
                              ? *std::move(known)
                              : diagnose(current, measured, part, step == 0 ? nullptr : &result.first, absent);
    if (step == 0) result.ladder.push_back(rung_of(diagnosis, false, {}));
    result.verdict = diagnosis.verdict;
    result.model = diagnosis.best;
    const Status status = diagnosis.verdict.status;
    if (diagnosis.by_effort) {
      append_effort_ladder(diagnosis, result);
      result.first = std::move(diagnosis);
      break;
    }
    const bool adds = status == Status::missing || status == Status::ambiguous;
    if (adds) {
      result.ladder.push_back(rung_of(diagnosis, true, modelled_kinds(diagnosis)));
    } else {
      result.stopped_because = status == Status::unexplained ? "no known effect explains the residual"
                               : status == Status::insufficient_data
                                   ? "these motions cannot show further effects"
                                   : "no known effect lowers the validation error significantly";
    }
    if (const JudgedCandidate* further = adds || step == 0 ? nullptr : halves_the_rest(diagnosis)) {
      result.ladder.push_back(rung_of(diagnosis, *further));
      result.model = further->model;
    }
    const double left = adds ? diagnosis.after_validate : diagnosis.before_validate;
    if (step == 0) result.first = std::move(diagnosis);
    if (!adds) break;
    current = result.model;
    if (left <= 1.0) {
      result.stopped_because = "the error has reached the noise floor";
      break;
    }
  }
  if (result.stopped_because.empty()) result.stopped_because = "the maximum number of steps was reached";
  document_fit(result.model, result.first.training);
  result.model.data = model.data;
  result.error = result.first.rows.error_of(result.model);
  keep_the_better(result, model);
  return result;
}

namespace {

Addition addition_of(const EffortScreen& screen, const ScreenedModel& added, const PreparedSets& sets) {
  Addition addition;
  addition.held_back = sets.held_back;
  addition.judged = judged_by_effort(screen, added);
  return addition;
}

/// The force balance with this effect as its only candidate.
EffortScreen screen_for(const std::string& kind, const sim::DriveDescription& model, const PreparedSets& sets) {
  std::vector<std::string> others;
  for (const sim::EffectInfo* effect : sim::catalogue())
    if (effect->kind != kind) others.emplace_back(effect->kind);
  return screen_effort(model, sets.training, sets.validation, 1, others);
}

/// The addition by least squares, if the regression decides and knows the effect.
std::optional<Addition> add_by_effort(const EffortScreen& screen, const std::string& kind, const PreparedSets& sets) {
  if (!effort_decides(screen, sets.validation) || screen.steps.empty()) return {};
  for (const ScreenedModel& tried : screen.steps.front()) {
    if (tried.kinds.size() != 1 || tried.kinds.front() != kind) continue;
    Addition addition = addition_of(screen, tried, sets);
    addition.estimates = document_fit(addition.judged.model, sets.training);
    return addition;
  }
  return {};
}

Addition curve_added(const sim::DriveDescription& model, const std::string& over, const Measurements& measured) {
  if (!over.empty() && std::ranges::find(sim::kCurveCoordinates, over) == std::end(sim::kCurveCoordinates))
    throw Failure(ExitCode::usage,
                  fmt::format("--over {}: give one of {}", over, fmt::join(sim::kCurveCoordinates, ", ")));
  const PreparedSets sets = split_sets(model, measured.training_records(), measured.validation_records());
  const EffortScreen screen = screen_effort(model, sets.training, sets.validation, 0);
  if (screen.empty())
    throw Failure(ExitCode::refused, "free_curve: the axis hardly moves in these records; record more motion");
  const std::optional<FreeCurveFit> fit = fit_free_curve(screen, over);
  if (!fit) throw Failure(ExitCode::refused, "free_curve: no curve lowers the error on validation data");
  Addition addition = addition_of(screen, fit->model, sets);
  for (const auto& [id, value] : fit->model.model.effects.back().parameters) {
    const auto interval = fit->model.model.effects.back().ci95.find(id);
    if (interval == fit->model.model.effects.back().ci95.end()) continue;
    const double deviation = 0.5 * (interval->second[1] - interval->second[0]) / kNormal95;
    addition.estimates.push_back({"free_curve." + id, value, deviation, true, {}, 0.0});
  }
  return addition;
}

Addition effect_added(const sim::DriveDescription& model, const std::string& kind, const Measurements& measured) {
  const sim::EffectInfo* info = sim::find_effect(kind);
  if (info == nullptr) throw Failure(ExitCode::usage, fmt::format("effect '{}' is unknown", kind));
  const PreparedSets split = split_sets(model, measured.training_records(), measured.validation_records());
  const EffortScreen screen = screen_for(kind, model, split);
  if (std::optional<Addition> by_effort = add_by_effort(screen, kind, split)) return *by_effort;
  std::optional<EffectByMotion> fitted = fit_effect_by_motion(*info, model, measured, with_base_fitted(split), &screen);
  if (!fitted)
    throw Failure(
        ExitCode::refused,
        fmt::format("{}: no starting value of the fit lowers the error; these records do not show the effect. {}", kind,
                    info->separate_by));
  PreparedSets& sets = fitted->sets;
  Addition addition;
  addition.held_back = sets.held_back;
  renew_floors(sets.training, fitted->best.model);
  addition.judged = judge_candidate(fitted->best, sets.training, sets.validation,
                                    error_over_own_floors(sets.base, sets.validation), 1);
  addition.estimates = document_fit(addition.judged.model, sets.training);
  return addition;
}

/// One after the other, each fitted with those before it. Only the last model is compared with the given one, because
/// some effects explain nothing without another.
Addition effects_added(const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                       const Measurements& measured) {
  Addition addition = effect_added(model, kinds.front(), measured);
  for (std::size_t k = 1; k < kinds.size(); ++k) {
    const double before = addition.judged.before;
    throw_if_cancelled();
    addition = effect_added(addition.judged.model, kinds[k], measured);
    addition.judged.before = before;
  }
  addition.judged.kinds = kinds;
  return addition;
}

/// Applies `adding` to the model with the measured sensor noise; keeps the given data sheet.
template <typename What>
Addition on_measured_sensors(Addition adding(const sim::DriveDescription&, const What&, const Measurements&),
                             const sim::DriveDescription& model, const What& what, const Measurements& measured) {
  Addition addition = adding(with_measured_sensors(model, measured), what, measured);
  addition.judged.model.data = model.data;
  const FigureRows rows = figure_rows(model, measured);
  addition.given = rows.error_of(model);
  addition.error = rows.error_of(addition.judged.model);
  addition.kept_given = is_worse(addition.error.validate, addition.given.validate);
  if (addition.kept_given) addition.judged.model = model;
  return addition;
}

}  // namespace

Addition add_effects(const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                     const Measurements& measured) {
  return on_measured_sensors(effects_added, model, kinds, measured);
}

Addition add_free_curve(const sim::DriveDescription& model, const std::string& over, const Measurements& measured) {
  return on_measured_sensors(curve_added, model, over, measured);
}

}  // namespace host
