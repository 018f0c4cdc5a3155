#include "host/diagnose/certainty.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "host/diagnose/all_clear.hpp"
#include "host/diagnose/claim.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/effort/effort_screen.hpp"

namespace host {

namespace {

using Kinds = std::vector<std::string>;

bool holds(const Kinds& all, const std::string& kind) { return std::ranges::find(all, kind) != all.end(); }

/// Probability that all effects in `certain` are present together with at least one of a group.
double probability_of_any(const Diagnosis& diagnosis, const Kinds& group, const Kinds& certain = {}) {
  double sum = 0.0;
  for (const JudgedCandidate& candidate : diagnosis.candidates)
    if (holds_all(candidate.kinds, certain) &&
        std::ranges::any_of(group, [&](const std::string& kind) { return holds(candidate.kinds, kind); }))
      sum += candidate.probability;
  return sum;
}

const JudgedCandidate* candidate_of(const Diagnosis& diagnosis, const Kinds& kinds) {
  const auto found = std::ranges::find_if(diagnosis.candidates, [&](const JudgedCandidate& candidate) {
    return std::ranges::is_permutation(candidate.kinds, kinds);
  });
  return found == diagnosis.candidates.end() ? nullptr : &*found;
}

/// Share of the squared error on held-back records that a candidate explains.
double taken_by(const JudgedCandidate& candidate) {
  const double before = candidate.before, after = candidate.after;
  return before > 0.0 ? 1.0 - after * after / (before * before) : 0.0;
}

/// Whether an effect is present together with certain ones with a probability of at least kClaimed, and takes enough of
/// what they leave.
bool is_certain_beside(Kinds certain, const std::string& kind, const Diagnosis& diagnosis) {
  if (holds(certain, kind)) return false;
  const JudgedCandidate* without = candidate_of(diagnosis, certain);
  certain.push_back(kind);
  const JudgedCandidate* with = candidate_of(diagnosis, certain);
  return with != nullptr && without != nullptr && explained_beyond(*without, *with) >= kWorthNaming &&
         probability_of(diagnosis, certain) >= kClaimed;
}

/// The smallest set of most probable effects such that one of them is present beside `certain` with a probability of at
/// least kClaimed. From a set of more than two, effects that are improbable by themselves are left out. Empty if more
/// than kLargestGroup remain, or if one of them explains too little.
Kinds rivals_beside(const Kinds& certain, const Diagnosis& diagnosis) {
  std::vector<const JudgedCandidate*> further;
  for (const JudgedCandidate& candidate : diagnosis.candidates)
    if (candidate.kinds.size() == certain.size() + 1 && holds_all(candidate.kinds, certain))
      further.push_back(&candidate);
  std::ranges::stable_sort(further, std::greater(), &JudgedCandidate::probability);
  Kinds group;
  for (const JudgedCandidate* candidate : further) {
    if (taken_by(*candidate) < kWorthNaming) break;
    group.push_back(
        *std::ranges::find_if(candidate->kinds, [&](const std::string& kind) { return !holds(certain, kind); }));
    if (probability_of_any(diagnosis, group, certain) < kClaimed) continue;
    while (group.size() > 2 && probability_of_any(diagnosis, {group.back()}, certain) <= 1.0 - kClaimed)
      group.pop_back();
    return group.size() > 1 && group.size() <= kLargestGroup ? group : Kinds{};
  }
  return {};
}

void leave_unexplained(Diagnosis& diagnosis) {
  DiagnosisVerdict& verdict = diagnosis.verdict;
  const auto best = std::ranges::max_element(diagnosis.candidates, {}, &JudgedCandidate::probability);
  verdict.explanation += fmt::format(
      " This is not claimed: {} has a probability of {:.0f} %, an effect outside the candidates {:.0f} %; a claim "
      "needs {:.0f} %.",
      fmt::join(best->kinds, " + "), 100.0 * best->probability, 100.0 * verdict.probability_other, 100.0 * kClaimed);
  verdict.status = Status::unexplained;
  verdict.effects.clear();
  verdict.alternatives.clear();
}

void become_ambiguous(Diagnosis& diagnosis, Kinds group) {
  diagnosis.verdict.status = Status::ambiguous;
  diagnosis.verdict.effects = group;
  diagnosis.verdict.alternatives = {std::move(group)};
}

/// The channel with the largest error over its noise floor before effects are added. The shares of the error of the
/// motion refer to it.
std::string told_channel(const Diagnosis& diagnosis) {
  const ChannelFigures* worst = diagnosis.base_error.validate.worst();
  return worst == nullptr ? std::string() : worst->name;
}

double share_in(const ErrorFigures& error, const std::string& name) {
  const auto channel = std::ranges::find(error.channels, name, &ChannelFigures::name);
  return channel == error.channels.end() ? 0.0 : channel->share.value_or(0.0);
}

void fill_by_effort(Diagnosis& diagnosis) {
  const EffortScreen& screen = *diagnosis.screen;
  for (const CertainEffect& effect : screen.certain)
    if (effect.group.size() == 1)
      diagnosis.verdict.found.push_back({effect.group, effect.probability, effect.before, effect.after});
}

/// Fills the errors after each effect, as far as the search fitted the models in between.
void fill_by_motion(Diagnosis& diagnosis) {
  const std::string channel = told_channel(diagnosis);
  Kinds kinds;
  for (const JudgedCandidate& candidate : diagnosis.candidates)
    for (const std::string& kind : candidate.kinds)
      if (!holds(kinds, kind) && probability_of(diagnosis, {kind}) >= kClaimed) kinds.push_back(kind);
  std::ranges::stable_sort(kinds, std::greater(),
                           [&](const std::string& kind) { return probability_of(diagnosis, {kind}); });
  double before = share_in(diagnosis.base_error.validate, channel);
  Kinds so_far, open;
  for (const std::string& kind : kinds) {
    so_far.push_back(kind);
    open.push_back(kind);
    const JudgedCandidate* candidate = candidate_of(diagnosis, so_far);
    if (candidate == nullptr) continue;
    const double after = share_in(diagnosis.rows.error_of(candidate->model).validate, channel);
    diagnosis.verdict.found.push_back({open, probability_of(diagnosis, open), before, after});
    open.clear();
    before = after;
  }
}

}  // namespace

bool holds_all(const std::vector<std::string>& all, const std::vector<std::string>& kinds) {
  return std::ranges::all_of(kinds, [&](const std::string& kind) { return holds(all, kind); });
}

double probability_of(const Diagnosis& diagnosis, const std::vector<std::string>& kinds) {
  double sum = 0.0;
  for (const JudgedCandidate& candidate : diagnosis.candidates)
    if (holds_all(candidate.kinds, kinds)) sum += candidate.probability;
  return sum;
}

void settle_status(Diagnosis& diagnosis) {
  DiagnosisVerdict& verdict = diagnosis.verdict;
  const bool named = verdict.status == Status::missing || verdict.status == Status::ambiguous;
  if (!named || diagnosis.candidates.empty()) return;
  if (verdict.status == Status::ambiguous && probability_of_any(diagnosis, verdict.effects) >= kClaimed) return;
  const JudgedCandidate* whole = candidate_of(diagnosis, verdict.effects);
  const bool hardly_helps = whole != nullptr && taken_by(*whole) < kWorthNaming;
  // All named effects are certain together; other effects of the best candidate are at most part of a group of rivals.
  Kinds together;
  if (verdict.status == Status::missing && !hardly_helps) {
    for (const std::string& kind : verdict.effects) {
      together.push_back(kind);
      if (probability_of(diagnosis, together) < kClaimed) together.pop_back();
    }
    for (const std::string& kind :
         std::ranges::max_element(diagnosis.candidates, {}, &JudgedCandidate::probability)->kinds)
      if (!together.empty() && is_certain_beside(together, kind, diagnosis)) together.push_back(kind);
  }
  if (!together.empty()) {
    const bool lost_some = !holds_all(together, verdict.effects);
    verdict.effects = std::move(together);
    std::erase_if(verdict.alternatives, [&](const Kinds& group) {
      return group.size() > kLargestGroup && !holds(verdict.effects, group.front());
    });
    if (Kinds group = lost_some ? rivals_beside(verdict.effects, diagnosis) : Kinds{};
        !group.empty() && std::ranges::none_of(verdict.alternatives, [&](const Kinds& other) {
          return std::ranges::any_of(group, [&](const std::string& kind) { return holds(other, kind); });
        }))
      verdict.alternatives.push_back(std::move(group));
    return;
  }
  Kinds group = rivals_beside({}, diagnosis);
  if (group.empty())
    leave_unexplained(diagnosis);
  else
    become_ambiguous(diagnosis, std::move(group));
}

std::vector<std::string> modelled_kinds(const Diagnosis& diagnosis) {
  const DiagnosisVerdict& verdict = diagnosis.verdict;
  if (diagnosis.by_effort && diagnosis.screen) return diagnosis.screen->best().kinds;
  if (verdict.status == Status::ambiguous) return {verdict.effects.front()};
  const auto is_named = [&](const std::string& kind) {
    return holds(verdict.effects, kind) ||
           std::ranges::any_of(verdict.alternatives, [&](const Kinds& group) { return holds(group, kind); });
  };
  const JudgedCandidate* modelled = nullptr;
  for (const JudgedCandidate& candidate : diagnosis.candidates)
    if (holds_all(candidate.kinds, verdict.effects) && std::ranges::all_of(candidate.kinds, is_named) &&
        (modelled == nullptr || candidate.probability > modelled->probability))
      modelled = &candidate;
  return modelled != nullptr && !verdict.effects.empty() ? modelled->kinds : verdict.effects;
}

void fill_found(Diagnosis& diagnosis) {
  DiagnosisVerdict& verdict = diagnosis.verdict;
  if (diagnosis.by_effort && diagnosis.screen)
    fill_by_effort(diagnosis);
  else
    fill_by_motion(diagnosis);
  const ErrorFigures& left = diagnosis.best_error.validate;
  if (verdict.effects.empty() || std::min(diagnosis.after_validate, left.combined) <= kExplained) return;
  const double share = diagnosis.by_effort && diagnosis.screen ? diagnosis.screen->best().validate
                                                               : share_in(left, told_channel(diagnosis));
  const Trace trace = strongest_trace(diagnosis, diagnosis.residual);
  verdict.remains = {share, left.combined, trace.coordinate, trace.where};
}

}  // namespace host
