#include "host/search/further_waves.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "host/compare/chance.hpp"
#include "host/fit/fit_budget.hpp"
#include "host/search/candidate_starts.hpp"
#include "host/search/explained_share.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

constexpr int kMostWaves = 12;  // limits the time

/// The model with the strongest waves of this effect in the residual, all at once: of several equal ones, each alone
/// hardly lowers the error. Empty if the residual has no further wave.
std::optional<sim::DriveDescription> with_next_waves(const sim::EffectInfo& info, const sim::DriveDescription& model,
                                                     const RecordSet& training) {
  sim::DriveDescription further = model;
  const double travel = scales_of(training).travel;
  const auto is_known = [&](const sim::EffectEntry& wave) {
    return std::ranges::any_of(model.effects, [&](const sim::EffectEntry& entry) {
      return entry.kind == info.kind && std::abs(1.0 / entry.at("period") - 1.0 / wave.at("period")) * travel < 1.0;
    });
  };
  for (sim::DriveDescription& start : starting_models(info, model, training))
    if (!is_known(start.effects.back())) further.effects.push_back(std::move(start.effects.back()));
  if (further.effects.size() == model.effects.size()) return {};
  return fit_model(further, training, kSeriousFit).model;
}

}  // namespace

void add_further_waves(Candidate& candidate, const PreparedSets& sets) {
  const sim::EffectInfo& info = *sim::find_effect(candidate.kinds.back());
  if (!info.periodic) return;
  for (int round = 0; round < kMostWaves && candidate.validation.combined > kExplained; ++round) {
    const std::optional<sim::DriveDescription> model = with_next_waves(info, candidate.model, sets.training);
    if (!model) return;
    Candidate further = judged(candidate.kinds, *model, sets.training, sets.validation);
    const double p_value = probability_of_luck(candidate.validation, further.validation, 1, sets.validation);
    if (p_value > kMostLuck || further.training.log_loss > candidate.training.log_loss) return;
    candidate = std::move(further);
  }
}

void hold_further_waves(sim::DriveDescription& model, const sim::DriveDescription& base,
                        const std::vector<std::string>& kinds, bool held) {
  for (const std::string& kind : kinds) {
    // Those of the base, and the first one added to it, come first.
    auto ahead = std::ranges::count(base.effects, kind, &sim::EffectEntry::kind) + 1;
    for (sim::EffectEntry& entry : model.effects) {
      if (entry.kind != kind || ahead-- > 0) continue;
      entry.held.clear();
      if (!held) continue;
      for (const auto& [id, value] : entry.parameters) entry.held.insert(id);
    }
  }
}

}  // namespace host
