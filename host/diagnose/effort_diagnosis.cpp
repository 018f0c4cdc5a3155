#include "host/diagnose/effort_diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/diagnose/all_clear.hpp"
#include "host/diagnose/certainty.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/effort/effort_terms.hpp"
#include "host/effort/free_curve_fit.hpp"
#include "host/infer/posterior.hpp"
#include "host/record/columns.hpp"
#include "host/report/text_format.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// Multiple of the sensor noise. The best model of a simulated drive leaves one to five times the sensor noise, that of
/// a real machine ten to sixty.
constexpr double kFarAboveNoise = 6.0;
/// Most effects named in one answer.
constexpr std::size_t kMostEffects = 6;

/// The titles of the effects of a step beyond the first `known`.
std::string described(const ScreenedModel& model, std::size_t known) {
  std::vector<std::string_view> titles;
  for (std::size_t k = known; k < model.kinds.size(); ++k) titles.push_back(sim::find_effect(model.kinds[k])->title);
  const std::string words = fmt::format("{}", fmt::join(titles, " and "));
  return model.words.empty() ? words : fmt::format("{} ({})", words, model.words);
}

std::string steps_in_words(const EffortScreen& screen) {
  std::string words;
  double before = screen.base.validate;
  std::size_t known = 0;
  for (const ScreenedModel& step : screen.chosen) {
    words += fmt::format(" {} reduce{} that from {:.1f} to {:.1f} %.", described(step, known),
                         step.kinds.size() - known == 1 ? "s" : "", 100.0 * before, 100.0 * step.validate);
    before = step.validate;
    known = step.kinds.size();
  }
  return words;
}

DiagnosisVerdict verdict_of(const EffortScreen& screen, const sim::DriveDescription& given) {
  DiagnosisVerdict verdict;
  verdict.parameters = moved_parameters(given, screen.best().model);
  verdict.explanation = fmt::format(
      "While the axis moves, inertia and friction leave {:.1f} % of the motor torque or force unexplained on "
      "validation data (least squares).",
      100.0 * screen.base.validate);
  if (screen.chosen.empty()) {
    verdict.status = Status::unexplained;
    verdict.explanation += " No known effect reduces this significantly on both training and validation data.";
    if (!screen.steps.empty() && !screen.steps.front().empty()) {
      const ScreenedModel& closest = screen.steps.front().front();
      verdict.explanation +=
          fmt::format(" The best candidate, {}, leaves {:.1f} %.", described(closest, 0), 100.0 * closest.validate);
    }
    verdict.next_experiment =
        "Repeat one motion ten times: a model can explain the part that repeats. Then jog at several speeds over the "
        "whole travel, in both directions.";
  } else {
    const std::string& first = screen.chosen.front().kinds.front();
    verdict.explanation += steps_in_words(screen);
    verdict.next_experiment = std::string(sim::find_effect(first)->separate_by) + ".";
    for (std::size_t step = 0; step < screen.chosen.size(); ++step) {
      const std::string& kind = screen.chosen[step].kinds.back();
      if (screen.tied[step].empty()) {
        verdict.effects.push_back(kind);
        continue;
      }
      std::vector<std::string> group = {kind};
      group.insert(group.end(), screen.tied[step].begin(), screen.tied[step].end());
      verdict.explanation += fmt::format(" These data cannot tell {} apart.", fmt::join(group, ", "));
      verdict.alternatives.push_back(std::move(group));
    }
    verdict.status = verdict.effects.empty() ? Status::ambiguous : Status::missing;
    if (verdict.effects.empty()) verdict.effects = verdict.alternatives.front();
  }
  if (screen.repeatable)
    verdict.explanation += fmt::format(
        " {:.0f} % of the residual repeats when the motion is repeated, so a better model could explain it; {:.1f} % "
        "of the torque or force is random (noise floor).",
        100.0 * screen.repeatable->share, 100.0 * screen.repeatable->floor / screen.effort_validate);
  for (const std::string& held : screen.held) verdict.explanation += fmt::format(" Held at the given value: {}.", held);
  if (screen.rows.by_speed && screen.rows.has_position)
    verdict.explanation +=
        " The motion was taken from the speed channel, because the differentiated position is noisier.";
  return verdict;
}

/// Lists every tried kind with its probability. The probabilities of a later step are multiplied by that of the earlier
/// steps. A kind chosen before the last step stands for its group.
void assign_evidence(const EffortScreen& screen, Diagnosis& diagnosis) {
  const std::size_t last = screen.chosen.size() - 1;  // above every step if none was chosen
  std::size_t whole = 0;
  double held = 1.0, others = 0.0;
  for (std::size_t step = 0; step < screen.steps.size(); ++step) {
    double group = 0.0;
    for (const ScreenedModel& tried : screen.steps[step]) {
      diagnosis.candidates.push_back(judged_by_effort(screen, tried));
      double& probability = diagnosis.candidates.back().probability;
      const bool is_chosen = step < screen.chosen.size() && tried.kinds == screen.chosen[step].kinds;
      const bool is_tied = step < screen.chosen.size() && std::ranges::count(screen.tied[step], tried.kinds.back()) > 0;
      if (is_chosen || (is_tied && step != last))
        group += tried.probability;
      else
        others += probability = held * tried.probability;
      if (is_chosen) whole = diagnosis.candidates.size() - 1;
    }
    if (step < screen.chosen.size()) held *= group;
  }
  DiagnosisVerdict& verdict = diagnosis.verdict;
  if (screen.chosen.empty()) {
    const double something = logistic(screen.memory_log_odds);
    verdict.probability_nothing = (1.0 - others) * (1.0 - something);
    verdict.probability_other = (1.0 - others) * something;
    return;
  }
  double further = 0.0;
  for (const JudgedCandidate& candidate : diagnosis.candidates)
    if (candidate.kinds.size() > diagnosis.candidates[whole].kinds.size()) further += candidate.probability;
  diagnosis.candidates[whole].probability = held - further;
  verdict.probability_other = 1.0 - (held - further) - others;
}

EffortError effort_error(const EffortScreen& screen) {
  const ScreenedModel &first = screen.base, &last = screen.best();
  return {first.model.data.kind == sim::DriveKind::rotary ? "effort_Nm" : "effort_N",
          first.train * screen.effort_train,
          first.validate * screen.effort_validate,
          last.train * screen.effort_train,
          last.validate * screen.effort_validate,
          screen.rows.noise,
          screen.rows.noise};
}

}  // namespace

double over_noise(const EffortScreen& screen, const ScreenedModel& model, bool judges) {
  const double residual = judges ? model.validate * screen.effort_validate : model.train * screen.effort_train;
  return residual / std::max(screen.rows.noise, 1e-12);
}

JudgedCandidate judged_by_effort(const EffortScreen& screen, const ScreenedModel& model) {
  JudgedCandidate candidate;
  candidate.kinds = model.kinds;
  candidate.before = over_noise(screen, screen.base, true);
  candidate.after = over_noise(screen, model, true);
  candidate.train_after = over_noise(screen, model, false);
  candidate.confidence = model.confidence;
  candidate.luck = 1.0 - model.confidence;
  candidate.model = model.model;
  return candidate;
}

bool is_explained(const EffortScreen& screen) {
  const double left = over_noise(screen, screen.best(), true), before = over_noise(screen, screen.base, true);
  return before > kFarAboveNoise && left < kExplainedPart * before;
}

bool effort_decides(const EffortScreen& screen, const RecordSet& validation) {
  if (screen.empty()) return false;
  const double left = over_noise(screen, screen.best(), true);
  // At steady speeds no error accumulates in the motion. A residual within noise then only means that these records
  // show no effect.
  if (screen.rows.steady && (!screen.chosen.empty() || left > kSmall)) return true;
  if (is_explained(screen)) return true;
  if (left < kFarAboveNoise) return false;
  return !screen.chosen.empty() || is_rough(error_of(sim::Drive(screen.base.model), validation));
}

namespace {

std::shared_ptr<const EffortScreen> screen_of(const sim::DriveDescription& model, const PreparedSets& sets,
                                              std::size_t most_effects) {
  return std::make_shared<EffortScreen>(
      screen_effort(model, sets.training, sets.validation, most_effects, sets.absent));
}

}  // namespace

std::shared_ptr<const EffortScreen> screen_of(const sim::DriveDescription& model, const PreparedSets& sets) {
  return screen_of(model, sets, kMostEffects);
}

std::shared_ptr<const EffortScreen> first_step_of(const sim::DriveDescription& model, const PreparedSets& sets) {
  return screen_of(model, sets, 1);
}

Diagnosis diagnosis_of(const sim::DriveDescription& model, const PreparedSets& sets,
                       std::shared_ptr<const EffortScreen> screen) {
  Diagnosis diagnosis(sets);
  diagnosis.measure = Measure::effort;
  diagnosis.rough = diagnosis.by_effort = true;
  diagnosis.base = screen->base.model;
  diagnosis.given_train = diagnosis.before_train = over_noise(*screen, screen->base, false);
  diagnosis.given_validate = diagnosis.before_validate = over_noise(*screen, screen->base, true);
  diagnosis.verdict = verdict_of(*screen, model);
  assign_evidence(*screen, diagnosis);
  std::ranges::stable_sort(diagnosis.candidates, {}, &JudgedCandidate::after);
  diagnosis.best = screen->best().model;
  diagnosis.after_train = over_noise(*screen, screen->best(), false);
  diagnosis.after_validate = over_noise(*screen, screen->best(), true);
  diagnosis.effort = effort_error(*screen);
  renew_floors(diagnosis.training, diagnosis.best);
  renew_floors(diagnosis.validation, diagnosis.best);
  diagnosis.where = error_regions(diagnosis.base, diagnosis.validation);
  diagnosis.screen = std::move(screen);
  return diagnosis;
}

namespace {

/// Whether the base fits each set, but with different values, for example after a warm-up between the records. If so,
/// adds this to the verdict.
bool differs_between_records(const EffortScreen& screen, DiagnosisVerdict& verdict) {
  constexpr double kSuits = 1.5, kFails = 2.0;  // times the residual of the base on the set to which it was fitted
  if (!screen.judge_alone) return false;
  const ScreenedModel &base = screen.base, &alone = *screen.judge_alone;
  if (alone.train > kSuits * base.train || base.validate < kFails * std::max(alone.train, base.train)) return false;
  std::vector<std::string> moved;
  for (const std::string& kind : moved_parameters(base.model, alone.model))
    for (const auto& [id, value] : base.model.find(kind)->parameters)
      moved.push_back(fmt::format("{} {:.4g} instead of {:.4g}",
                                  sim::find_effect(kind)->parameter(id)->key(base.model.data.kind),
                                  alone.model.find(kind)->at(id), value));
  if (moved.empty()) return false;
  verdict.coordinate = "time";
  verdict.where = "between the records";
  verdict.explanation += fmt::format(
      " Fitted to the validation records alone, inertia and friction leave {:.1f} %, with {}: the machine's state "
      "(temperature, load, lubrication) differed from that in training.",
      100.0 * alone.train, fmt::join(moved, ", "));
  verdict.next_experiment =
      "Record both motions in the same state of the machine, or alternately during warm-up, with its temperature "
      "(temp_C).";
  return true;
}

}  // namespace

std::string said_by_the_motion(const Diagnosis& diagnosis) {
  // An effect that explains less than half of the squared error is not confirmed.
  constexpr double kHalfOfTheSquare = 0.71;
  const EffortScreen* screen = diagnosis.screen.get();
  if (!diagnosis.by_effort || screen == nullptr || screen->chosen.empty() || screen->rows.steady) return {};
  const double before = diagnosis.base_error.validate.combined, after = diagnosis.best_error.validate.combined;
  const char* said = after < kHalfOfTheSquare * before ? "decreases, which confirms it"
                     : after < kHardly * before        ? "decreases slightly"
                     : after > before / kHardly
                         ? "increases, which does not confirm this effect; record more motion that excites it"
                         : "does not change";
  return fmt::format(" The error of the prediction from the command {} ({:.3g} -> {:.3g} times the noise floor).", said,
                     before, after);
}

void name_coordinate(Diagnosis& diagnosis) {
  // A curve with 25 knots explains this share of any residual, so a smaller share is not reported.
  constexpr double kLeastShare = 0.2;
  DiagnosisVerdict& verdict = diagnosis.verdict;
  if (verdict.status != Status::unexplained) return;
  if (verdict.coordinate.empty()) {
    Trace trace = strongest_trace(diagnosis, diagnosis.residual);
    verdict.coordinate = std::move(trace.coordinate);
    verdict.where = std::move(trace.where);
  }
  if (!diagnosis.screen || diagnosis.screen->empty() || speed_channel_alone_fails(diagnosis)) return;
  const EffortScreen& screen = *diagnosis.screen;
  if (differs_between_records(screen, verdict)) return;
  std::optional<FreeCurveFit> curve = fit_free_curve(screen);
  // Every quantity proportional to torque explains torque. So a curve over torque is offered only if the prediction of
  // the motion supports it and it explains more than the others.
  if (verdict.coordinate == "current")
    if (std::optional<FreeCurveFit> over_current = fit_free_curve(screen, "current");
        over_current && (!curve || over_current->model.validate < curve->model.validate))
      curve = std::move(over_current);
  if (!curve) return;
  const double ratio = curve->model.validate / screen.best().validate, share = 1.0 - ratio * ratio;
  if (share < kLeastShare) return;
  verdict.explanation += fmt::format(
      " A free curve of {} knots over {} explains {:.0f} % of the squared residual (axistool add MODEL free_curve "
      "--over {}).",
      curve->knots, spaced(curve->over), 100.0 * share, curve->over);
  if (curve->period > 0.0)
    verdict.explanation += fmt::format(" It repeats every {:.4g} {}.", curve->period,
                                       screen.base.model.data.kind == sim::DriveKind::rotary ? "mm" : "m");
  const std::string coordinate = curve->over == "friction_along_position" || curve->over == "phase" ? "position"
                                 : curve->over == "friction_over_time"                              ? "time"
                                                                                                    : curve->over;
  const auto along = [&](const std::string& name) {
    return std::ranges::find(diagnosis.residual.dependences, name, &ResidualDependence::coordinate);
  };
  const auto none = diagnosis.residual.dependences.end();
  const auto named = along(verdict.coordinate), taken = along(coordinate);
  // Every residual is correlated over short times, so a dependence on time does not count here.
  if (named != none && named->coordinate != "time" && named->share >= share) return;
  if (verdict.coordinate == coordinate) return;
  // A curve that explains much of the torque in sliding motion, but nothing of the prediction error, fits by chance.
  constexpr double kShows = 0.02;
  if (taken != none && std::max(taken->share, taken->in_detail) < kShows) return;
  verdict.coordinate = coordinate;
  verdict.where = taken == none ? "over all of it" : taken->where;
  verdict.explanation += fmt::format(" So it depends on {}.", spaced(coordinate));
}

nlohmann::json effort_screen_json(const EffortScreen& screen) {
  const auto relative = [](const ScreenedModel& model) {
    return nlohmann::json{{"train", model.train}, {"validate", model.validate}};
  };
  nlohmann::json steps = nlohmann::json::array();
  for (const ScreenedModel& step : screen.chosen)
    steps.push_back({{"kinds", step.kinds}, {"words", step.words}, {"relative_error", relative(step)}});
  return {{"rows", screen.rows.size()},
          {"motion_from", screen.rows.by_speed ? "speed" : "position"},
          {"inertia_shows", !screen.rows.steady},
          {"lowest_cutoff_Hz", screen.rows.lowest_cutoff_Hz},
          {"relative_error", {{"before", relative(screen.base)}, {"after", relative(screen.best())}}},
          {"steps", std::move(steps)},
          {"held", screen.held}};
}

}  // namespace host
