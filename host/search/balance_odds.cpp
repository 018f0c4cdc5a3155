#include "host/search/balance_odds.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "host/infer/posterior.hpp"
#include "sim/harmonic.hpp"
#include "sim/second_mass.hpp"

namespace host {

namespace {

/// A single wave that is written as an order of a turn gets its own period, as the waves found in a spectrum have.
void write_with_own_period(sim::EffectEntry& entry) {
  const std::vector<sim::HarmonicTerm> waves = sim::harmonics_of(entry);
  if (waves.size() != 1) return;
  entry.parameters["period"] /= waves.front().order;
  sim::set_harmonics(entry, {{1.0, waves.front().cosine, waves.front().sine}});
}

/// The models of the balance with one effect added to `kinds`; none if it did not choose these.
std::vector<const ScreenedModel*> tried_beside(const EffortScreen& balance, const std::vector<std::string>& kinds) {
  std::vector<const ScreenedModel*> tried;
  for (const std::vector<ScreenedModel>& step : balance.steps) {
    for (const ScreenedModel& one : step)
      if (one.kinds.size() == kinds.size() + 1 && std::is_permutation(kinds.begin(), kinds.end(), one.kinds.begin()))
        tried.push_back(&one);
    if (!tried.empty()) break;
  }
  return tried;
}

}  // namespace

std::vector<std::string> probable_kinds(const EffortScreen& balance, const std::vector<std::string>& kinds) {
  std::vector<const ScreenedModel*> tried = tried_beside(balance, kinds);
  std::ranges::stable_sort(tried, std::greater(), &ScreenedModel::probability);
  std::vector<std::string> probable;
  double together = 0.0;
  for (const ScreenedModel* one : tried) {
    if (together >= kClaimed) break;
    together += one->probability;
    probable.push_back(one->kinds.back());
  }
  if (together < kClaimed) probable.clear();
  return probable;
}

bool are_told_apart(const EffortScreen& balance, const std::vector<std::string>& kinds, std::string_view leader,
                    std::string_view other) {
  const ScreenedModel *ahead = nullptr, *behind = nullptr;
  for (const ScreenedModel* one : tried_beside(balance, kinds)) {
    if (one->kinds.back() == leader) ahead = one;
    if (one->kinds.back() == other) behind = one;
  }
  return ahead != nullptr && behind != nullptr && behind->log_odds < ahead->log_odds + std::log(kPossible);
}

bool allows_second_mass(const EffortScreen& balance, const std::vector<std::string>& kinds) {
  for (const std::vector<std::string>& beside : {kinds, {}}) {
    std::vector<const ScreenedModel*> tried = tried_beside(balance, beside);
    std::erase_if(tried, [](const ScreenedModel* one) { return !sim::is_second_mass(one->kinds.back()); });
    if (!tried.empty()) return std::ranges::any_of(tried, [](const ScreenedModel* one) { return one->log_odds > 0.0; });
  }
  return true;
}

std::optional<sim::DriveDescription> balanced_start(const EffortScreen& balance, std::vector<std::string> kinds,
                                                    const sim::EffectInfo& info) {
  kinds.emplace_back(info.kind);
  for (const std::vector<ScreenedModel>& step : balance.steps)
    for (const ScreenedModel& tried : step) {
      if (!std::ranges::is_permutation(tried.kinds, kinds)) continue;
      sim::DriveDescription model = tried.model;
      const auto entry = std::ranges::find(model.effects, info.kind, &sim::EffectEntry::kind);
      if (info.periodic) write_with_own_period(*entry);
      std::rotate(entry, entry + 1, model.effects.end());
      return model;
    }
  return {};
}

}  // namespace host
