#include "host/effort/next_effects.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "host/infer/posterior.hpp"

namespace host {

void renew_probabilities(NextEffects& next) {
  std::vector<double> logs{next.log_nothing};
  for (const NextEffect& effect : next.effects) logs.push_back(effect.log_weight);
  const std::vector<double> probabilities = posterior(logs);
  next.nothing = probabilities.front();
  for (std::size_t k = 0; k < next.effects.size(); ++k) next.effects[k].probability = probabilities[k + 1];
}

std::vector<std::string> certain_group(const NextEffects& next, double& probability) {
  std::vector<std::string> group;
  probability = 0.0;
  for (const NextEffect& effect : next.effects) {
    if (probability >= kClaimed || effect.probability < next.nothing || group.size() == kLargestGroup) break;
    group.push_back(effect.term.kind);
    probability += effect.probability;
  }
  if (probability < kClaimed) group.clear();
  return group;
}

void leave_unnamed(NextEffects& next) {
  std::vector<double> logs{next.log_nothing};
  for (const NextEffect& effect : next.effects)
    if (effect.term.kind == kNoName) logs.push_back(effect.log_weight);
  next.log_nothing = log_sum(logs);
  take_out(next, {kNoName});
}

void take_out(NextEffects& next, const std::vector<std::string>& kinds) {
  std::erase_if(next.effects,
                [&](const NextEffect& effect) { return std::ranges::find(kinds, effect.term.kind) != kinds.end(); });
  renew_probabilities(next);
}

void leave_nothing(NextEffects& next) {
  next.effects.clear();
  next.nothing = 1.0;
}

void give_place(NextEffects& next, const std::string& kind, NextEffect to) {
  std::vector<double> logs;
  for (const NextEffect& effect : next.effects)
    if (effect.term.kind == kind || effect.term.kind == to.term.kind) {
      logs.push_back(effect.log_weight);
      to.log_odds = std::max(to.log_odds, effect.log_odds);
    }
  to.log_weight = log_sum(logs);
  std::erase_if(next.effects,
                [&](const NextEffect& effect) { return effect.term.kind == kind || effect.term.kind == to.term.kind; });
  next.effects.push_back(std::move(to));
  renew_probabilities(next);
  std::ranges::stable_sort(next.effects, std::greater(), &NextEffect::log_weight);
}

NextEffect& effect_of(NextEffects& next, const std::string& kind) {
  return *std::ranges::find(next.effects, kind, [](const NextEffect& other) { return other.term.kind; });
}

}  // namespace host
