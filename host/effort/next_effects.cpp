#include "host/effort/next_effects.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "host/infer/posterior.hpp"

namespace host {

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
  for (const NextEffect& effect : next.effects)
    if (effect.term.kind == kNoName) next.nothing += effect.probability;
  std::erase_if(next.effects, [](const NextEffect& effect) { return effect.term.kind == kNoName; });
}

void take_out(NextEffects& next, const std::vector<std::string>& kinds) {
  std::erase_if(next.effects,
                [&](const NextEffect& effect) { return std::ranges::find(kinds, effect.term.kind) != kinds.end(); });
  double sum = next.nothing;
  for (const NextEffect& effect : next.effects) sum += effect.probability;
  next.nothing = sum > 0.0 ? next.nothing / sum : 1.0;
  for (NextEffect& effect : next.effects) effect.probability = sum > 0.0 ? effect.probability / sum : 0.0;
}

void leave_nothing(NextEffects& next) {
  next.effects.clear();
  next.nothing = 1.0;
}

void give_place(NextEffects& next, const std::string& kind, NextEffect to) {
  to.probability = 0.0;
  for (const NextEffect& effect : next.effects)
    if (effect.term.kind == kind || effect.term.kind == to.term.kind) {
      to.probability += effect.probability;
      to.log_odds = std::max(to.log_odds, effect.log_odds);
    }
  std::erase_if(next.effects,
                [&](const NextEffect& effect) { return effect.term.kind == kind || effect.term.kind == to.term.kind; });
  next.effects.push_back(std::move(to));
  std::ranges::stable_sort(next.effects, std::greater(), &NextEffect::probability);
}

NextEffect& effect_of(NextEffects& next, const std::string& kind) {
  return *std::ranges::find(next.effects, kind, [](const NextEffect& other) { return other.term.kind; });
}

}  // namespace host
