#include "host/diagnose/connection.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "host/diagnose/effort_diagnosis.hpp"
#include "host/effort/effort_screen.hpp"
#include "host/effort/second_mass_terms.hpp"
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

/// The same verdict with another connection in place of one.
void exchange(const std::string& from, const sim::EffectEntry& to, Diagnosis& diagnosis) {
  const auto rename_in = [&](std::vector<std::string>& kinds) { std::ranges::replace(kinds, from, to.kind); };
  const auto exchange_in = [&](auto& candidate) {
    rename_in(candidate.kinds);
    if (sim::EffectEntry* entry = candidate.model.find(from)) *entry = to;
  };
  auto exchanged = std::make_shared<EffortScreen>(*diagnosis.screen);
  std::ranges::for_each(exchanged->chosen, exchange_in);
  for (CertainEffect& certain : exchanged->certain) rename_in(certain.group);
  std::ranges::for_each(exchanged->tied, rename_in);
  diagnosis.screen = std::move(exchanged);
  std::ranges::for_each(diagnosis.candidates, exchange_in);
  rename_in(diagnosis.verdict.effects);
  std::ranges::for_each(diagnosis.verdict.alternatives, rename_in);
}

}  // namespace

bool is_connection(std::string_view kind) { return std::ranges::find(kConnections, kind) != kConnections.end(); }

void compare_spring_with_gap_by_motion(Diagnosis& diagnosis, const std::vector<std::string>& absent) {
  const std::string spring(kConnections[0]), gap(kConnections[1]);
  if (named_by_balance(diagnosis) != spring) return;
  const auto holds_gap = [&](const std::vector<std::string>& kinds) {
    return std::ranges::find(kinds, gap) != kinds.end();
  };
  if (holds_gap(absent) || std::ranges::any_of(diagnosis.screen->tied, holds_gap)) return;
  sim::DriveDescription rest = diagnosis.screen->best().model;
  std::erase_if(rest.effects, [&](const sim::EffectEntry& entry) { return entry.kind == spring; });
  const std::vector<Candidate> fitted = search_kinds({sim::find_effect(spring), sim::find_effect(gap)}, rest, {},
                                                     diagnosis.training, diagnosis.validation);
  const auto of = [&](const std::string& kind) {
    return std::ranges::find(fitted, std::vector{kind}, &Candidate::kinds);
  };
  const auto with_spring = of(spring), with_gap = of(gap);
  if (with_gap == fitted.end()) return;
  const Candidate rival =
      with_spring == fitted.end() ? judged({}, rest, rest, diagnosis.training, diagnosis.validation) : *with_spring;
  constexpr double kBetter = 1.1;  // as of models that predict equally well
  if (kBetter * with_gap->training.combined >= rival.training.combined ||
      kBetter * with_gap->validation.combined >= rival.validation.combined)
    return;
  const sim::EffectEntry& entry = *with_gap->model.find(gap);
  if (entry.at("gap") < least_gap(rest.data)) return;
  exchange(spring, entry, diagnosis);
  diagnosis.best = with_gap->model;
  diagnosis.verdict.explanation +=
      " While the axis slides, a gap and a spring hardly differ. At reversals they do, and a gap predicts the motion "
      "better.";
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
