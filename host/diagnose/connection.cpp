#include "host/diagnose/connection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "host/diagnose/certainty.hpp"
#include "host/diagnose/claim.hpp"
#include "host/diagnose/effect_by_motion.hpp"
#include "host/diagnose/effort_diagnosis.hpp"
#include "host/effort/effort_screen.hpp"
#include "host/effort/second_mass_terms.hpp"
#include "host/evidence/measured_sensors.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// The connection that the force balance names; empty if it names neither, or if it did not decide.
std::string named_by_balance(const Diagnosis& diagnosis) {
  const EffortScreen* screen = diagnosis.screen.get();
  if (!diagnosis.by_effort || screen == nullptr || screen->rows.steady) return {};
  const std::vector<std::string>& kinds = screen->best().kinds;
  const auto named = std::ranges::find_if(kinds, is_connection);
  return named == kinds.end() ? std::string() : *named;
}

/// A model with one connection, fitted to the motion.
struct ByMotion {
  sim::DriveDescription model;
  ErrorOnSets error;
};

/// Predicts both sets better.
bool is_better(const ErrorOnSets& one, const ErrorOnSets& other) {
  return kAsGood * one.train.combined < other.train.combined &&
         kAsGood * one.validate.combined < other.validate.combined;
}

/// The better of two fits of one connection: alone, and beside the other effects that the balance names.
std::optional<ByMotion> fitted_connection(const std::string& kind, const Diagnosis& diagnosis,
                                          const sim::DriveDescription& model, const Measurements& measured,
                                          const PreparedSets& fitted) {
  const sim::EffectInfo& effect = *sim::find_effect(kind);
  std::optional<ByMotion> best;
  if (std::optional<EffectByMotion> alone = fit_effect_by_motion(effect, model, measured, fitted))
    best = ByMotion{alone->best.model, diagnosis.rows.error_of(alone->best.model)};
  sim::DriveDescription others = diagnosis.screen->best().model;
  std::erase_if(others.effects, [](const sim::EffectEntry& entry) { return is_connection(entry.kind); });
  const std::vector<Candidate> beside = search_kinds({&effect}, others, {}, diagnosis.training, diagnosis.validation);
  if (beside.empty()) return best;
  ByMotion more{beside.front().model, diagnosis.rows.error_of(beside.front().model)};
  return !best || is_better(more.error, best->error) ? std::move(more) : std::move(best);
}

/// The verdict of the balance with a gap in place of its spring. Of its other effects those remain that the model has.
void exchange_spring(const sim::DriveDescription& with_gap, Diagnosis& diagnosis) {
  auto screen = std::make_shared<EffortScreen>(*diagnosis.screen);
  const std::vector<std::string> named = screen->best().kinds;
  const auto is_withdrawn = [&](const std::string& kind) {
    return kind != kSpring && holds_all(named, {kind}) && with_gap.find(kind) == nullptr;
  };
  const auto rename_in = [](std::vector<std::string>& kinds) {
    std::ranges::replace(kinds, std::string(kSpring), std::string(kGap));
  };
  const auto exchange_in = [&](std::vector<std::string>& kinds) {
    std::erase_if(kinds, is_withdrawn);
    rename_in(kinds);
  };
  std::vector<ScreenedModel> steps;
  std::vector<std::vector<std::string>> tied;
  for (std::size_t step = 0; step < screen->chosen.size(); ++step) {
    ScreenedModel& chosen = screen->chosen[step];
    if (is_withdrawn(chosen.kinds.back())) continue;
    exchange_in(chosen.kinds);
    rename_in(screen->tied[step]);
    chosen.model = with_gap;
    steps.push_back(std::move(chosen));
    tied.push_back(std::move(screen->tied[step]));
  }
  screen->chosen = std::move(steps);
  screen->tied = std::move(tied);
  std::erase_if(screen->certain,
                [&](const CertainEffect& certain) { return std::ranges::all_of(certain.group, is_withdrawn); });
  for (CertainEffect& certain : screen->certain) rename_in(certain.group);

  DiagnosisVerdict& verdict = diagnosis.verdict;
  std::vector<JudgedCandidate> candidates;
  for (JudgedCandidate& candidate : diagnosis.candidates) {
    const bool is_named = candidate.kinds == named;
    if (is_named) {
      candidate.model = with_gap;
      exchange_in(candidate.kinds);
    } else {
      const bool is_beside_withdrawn = std::ranges::any_of(candidate.kinds, is_withdrawn);
      rename_in(candidate.kinds);
      if (sim::EffectEntry* spring = candidate.model.find(kSpring)) *spring = *with_gap.find(kGap);
      if (is_beside_withdrawn || candidate.kinds == screen->best().kinds) {
        verdict.probability_other += candidate.probability;
        continue;
      }
    }
    candidates.push_back(std::move(candidate));
  }
  diagnosis.candidates = std::move(candidates);
  diagnosis.screen = std::move(screen);
  diagnosis.best = with_gap;
  exchange_in(verdict.effects);
  std::erase_if(verdict.alternatives,
                [&](const std::vector<std::string>& group) { return is_withdrawn(group.front()); });
  std::ranges::for_each(verdict.alternatives, rename_in);
  if (verdict.effects.empty()) {  // of the spring's group alone
    verdict.status = Status::ambiguous;
    verdict.effects = verdict.alternatives.front();
  }
  for (const std::string& kind : named)
    if (is_withdrawn(kind))
      verdict.explanation +=
          fmt::format(" {}, found beside the spring, does not improve the prediction with a gap and is withdrawn.",
                      sim::find_effect(kind)->title);
}

}  // namespace

bool is_connection(std::string_view kind) { return std::ranges::find(kConnections, kind) != kConnections.end(); }

void compare_spring_with_gap_by_motion(Diagnosis& diagnosis, const sim::DriveDescription& given,
                                       const Measurements& measured, const std::vector<std::string>& absent) {
  if (named_by_balance(diagnosis) != kSpring) return;
  const auto holds_gap = [](const std::vector<std::string>& kinds) {
    return std::ranges::find(kinds, kGap) != kinds.end();
  };
  if (holds_gap(absent) || std::ranges::any_of(diagnosis.screen->tied, holds_gap)) return;
  const sim::DriveDescription model = with_measured_sensors(given, measured);
  const PreparedSets sets =
      with_base_fitted(split_sets(model, measured.training_records(), measured.validation_records()));
  const auto fitted = [&](std::string_view kind) {
    return fitted_connection(std::string(kind), diagnosis, model, measured, sets);
  };
  const std::optional<ByMotion> gap = fitted(kGap);
  if (!gap || gap->model.find(kGap)->at("gap") < least_gap(gap->model.data)) return;
  const std::optional<ByMotion> spring = fitted(kSpring);
  const ErrorOnSets balance = diagnosis.rows.error_of(diagnosis.screen->best().model);
  if (!is_better(gap->error, balance) || (spring && !is_better(gap->error, spring->error))) return;
  diagnosis.verdict.explanation +=
      " While the axis slides, a gap and a spring hardly differ. At reversals they do, and a gap predicts the motion "
      "better.";
  exchange_spring(gap->model, diagnosis);
}

void take_back_denied_connection(Diagnosis& diagnosis) {
  if (named_by_balance(diagnosis).empty()) return;
  if (diagnosis.best_error.validate.combined <= diagnosis.base_error.validate.combined / kHardly) return;
  DiagnosisVerdict& verdict = diagnosis.verdict;
  verdict.status = Status::unexplained;
  verdict.effects.clear();
  verdict.alternatives.clear();
  verdict.explanation += " Torque and motion contradict each other, so nothing is named.";
  verdict.next_experiment =
      "Measure the table: with a scale (column x2_mm), or by a dial gauge at reversals (axistool dial). " +
      verdict.next_experiment;
  // Either measure may be the wrong one.
  for (JudgedCandidate& candidate : diagnosis.candidates) candidate.probability *= 0.5;
  verdict.probability_nothing *= 0.5;
  verdict.probability_other = 0.5 * (1.0 + verdict.probability_other);
  auto denied = std::make_shared<EffortScreen>(*diagnosis.screen);
  denied->chosen.clear();
  denied->tied.clear();
  denied->certain.clear();
  diagnosis.screen = std::move(denied);
  diagnosis.best = diagnosis.base;
  diagnosis.best_error = diagnosis.base_error;
  diagnosis.after_train = diagnosis.before_train;
  diagnosis.after_validate = diagnosis.before_validate;
}

}  // namespace host
