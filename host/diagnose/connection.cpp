#include "host/diagnose/connection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "host/diagnose/effort_diagnosis.hpp"
#include "host/effort/second_mass_terms.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

bool names_connection(const ScreenedModel& step) { return std::ranges::any_of(step.kinds, is_connection); }

/// Both connections as effects of `rest`, fitted in the motion; those that lower the error on a few windows.
std::vector<Candidate> fitted_connections(const sim::DriveDescription& rest, const PreparedSets& sets) {
  std::vector<const sim::EffectInfo*> infos;
  for (const std::string_view kind : kConnections) infos.push_back(sim::find_effect(kind));
  return search_kinds(infos, rest, {}, sets.training, sets.validation);
}

}  // namespace

bool is_connection(std::string_view kind) { return std::ranges::find(kConnections, kind) != kConnections.end(); }

std::shared_ptr<const EffortScreen> with_connection_of_motion(const EffortScreen& screen, const PreparedSets& sets) {
  const auto step = std::ranges::find_if(screen.chosen, names_connection);
  if (screen.rows.steady || step == screen.chosen.end()) return nullptr;
  const auto place = static_cast<std::size_t>(step - screen.chosen.begin());
  const std::string named = *std::ranges::find_if(step->kinds, is_connection);
  const std::string other(kConnections[named == kConnections[0] ? 1 : 0]);
  const auto is_other = [&](const std::vector<std::string>& kinds) {
    return std::ranges::find(kinds, other) != kinds.end();
  };
  if (is_other(sets.absent) || is_other(screen.tied[place])) return nullptr;
  // The balance's friction is that of sliding alone, from which a fit of the motion may not find back.
  sim::DriveDescription rest = with_base_fitted(sets).base;
  if (place > 0)
    for (const std::string& kind : screen.chosen[place - 1].kinds)
      rest.effects.push_back(*screen.chosen[place - 1].model.find(kind));
  const std::vector<Candidate> fitted = fitted_connections(rest, sets);
  const auto of = [&](const std::string& kind) {
    return std::ranges::find(fitted, std::vector{kind}, &Candidate::kinds);
  };
  if (of(other) == fitted.end()) return nullptr;
  const Candidate &better = *of(other), rival = of(named) == fitted.end()
                                                    ? judged({}, rest, rest, sets.training, sets.validation)
                                                    : *of(named);
  constexpr double kBetter = 1.1;  // as of models that predict equally well
  if (kBetter * better.training.combined >= rival.training.combined ||
      kBetter * better.validation.combined >= rival.validation.combined)
    return nullptr;
  const sim::EffectEntry& entry = *better.model.find(other);
  if (entry.has("gap") && entry.at("gap") < least_gap(rest.data)) return nullptr;
  auto exchanged = std::make_shared<EffortScreen>(screen);
  exchanged->chosen.resize(place + 1);
  exchanged->tied.resize(place + 1);
  exchanged->steps.resize(place + 1);
  const auto exchange_in = [&](ScreenedModel& model) {
    std::ranges::replace(model.kinds, named, other);
    model.model = better.model;
    model.words = fmt::format("by the motion: error over noise floor {:.3g} instead of {:.3g}",
                              better.validation.combined, rival.validation.combined);
  };
  std::erase_if(exchanged->steps.back(), [&](const ScreenedModel& tried) { return is_other(tried.kinds); });
  for (ScreenedModel& tried : exchanged->steps.back())
    if (tried.kinds == step->kinds) exchange_in(tried);
  exchange_in(exchanged->chosen.back());
  const auto certain = std::ranges::find_if(exchanged->certain,
                                            [&](const CertainEffect& effect) { return effect.group.front() == named; });
  if (certain != exchanged->certain.end()) {
    certain->group.front() = other;
    exchanged->certain.erase(std::next(certain), exchanged->certain.end());
  }
  return exchanged;
}

void take_back_denied_connection(Diagnosis& diagnosis) {
  const EffortScreen* screen = diagnosis.screen.get();
  if (!diagnosis.by_effort || screen == nullptr || screen->rows.steady || !names_connection(screen->best())) return;
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
  auto denied = std::make_shared<EffortScreen>(*screen);
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
