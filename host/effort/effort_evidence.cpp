#include "host/effort/effort_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/cancellation.hpp"
#include "host/effort/closest_form.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/infer/posterior.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

/// More rows say nothing new of a dozen parameters and cost time with the square of the memory's columns.
constexpr std::size_t kMostRows = 2500;
/// Further waves of a kind included.
constexpr int kMostSteps = 12;
/// A group of more kinds is no answer.
constexpr std::size_t kLargestGroup = 4;

bool contains(const std::vector<std::string>& kinds, const std::string& kind) {
  return std::ranges::find(kinds, kind) != kinds.end();
}

/// Fewest kinds that together are certain, most probable first; empty where "nothing more" is more probable than one of
/// them, or too many are needed.
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

class Search {
 public:
  Search(const sim::DriveDescription& model, const EffortRows& rows, std::vector<std::string> absent)
      : rows_(rows), base_(base_terms(model, rows)), regression_(model, rows), excluded_(std::move(absent)) {}

  bool fit_base() { return regression_.fit(base_, {}, found_.base); }
  const std::vector<EffortTerm>& base() const { return base_; }
  const ScreenedModel& fitted_base() const { return found_.base; }

  EffortEvidence run(const EffortHypotheses& hypotheses) {
    found_.best = found_.base;
    for (int round = 0; round < kMostSteps && step(hypotheses); ++round) throw_if_cancelled();
    found_.memory_log_odds = hypotheses.memory_log_odds(left_, chosen_);
    return std::move(found_);
  }

 private:
  /// The best model with a further term, fitted to the training rows; its kinds hold the term's once.
  bool with(EffortTerm& term, ScreenedModel& out) const {
    std::vector<const EffortTerm*> further;
    for (const EffortTerm& before : chosen_) further.push_back(&before);
    further.push_back(&term);
    if (!regression_.fit(base_, further, out)) return false;
    out.words = term.words;
    if (term.neighbours) term = closest_form(regression_, base_, chosen_, std::move(term), out);
    out.kinds = found_.best.kinds;
    if (!contains(out.kinds, term.kind)) out.kinds.push_back(term.kind);
    return true;
  }

  /// Takes a kind that validation rows contradict out of what may come next: what the rows hold there is something that
  /// no effect of the catalogue is.
  void contradict(NextEffects& next, const std::string& kind) {
    for (const NextEffect& effect : next.effects)
      if (effect.term.kind == kind) next.nothing += effect.probability;
    std::erase_if(next.effects, [&](const NextEffect& effect) { return effect.term.kind == kind; });
    excluded_.push_back(kind);
  }

  /// Takes kinds that are certain, but small, out of what may come next; the others share their probability.
  void set_aside(NextEffects& next, const std::vector<std::string>& kinds) {
    std::erase_if(next.effects, [&](const NextEffect& effect) { return contains(kinds, effect.term.kind); });
    double sum = next.nothing;
    for (const NextEffect& effect : next.effects) sum += effect.probability;
    next.nothing = sum > 0.0 ? next.nothing / sum : 1.0;
    for (NextEffect& effect : next.effects) effect.probability = sum > 0.0 ? effect.probability / sum : 0.0;
    excluded_.insert(excluded_.end(), kinds.begin(), kinds.end());
  }

  /// Adds the most probable effect that is certain, holds on validation rows and takes enough of the error; false where
  /// none does.
  bool step(const EffortHypotheses& hypotheses) {
    const ScreenedModel& before = found_.best;
    NextEffects next = hypotheses.next(chosen_, rows_.effort - before.residual, excluded_);
    left_ = next.fit;
    while (true) {
      double probability = 0.0;
      const std::vector<std::string> group = certain_group(next, probability);
      found_.nothing = next.nothing;
      if (group.empty()) return false;
      const std::string& kind = group.front();
      EffortTerm& term =
          std::ranges::find(next.effects, kind, [](const NextEffect& effect) { return effect.term.kind; })->term;
      ScreenedModel taken;
      // Motions that no fit has seen have the last word.
      if (!with(term, taken) || taken.validate >= before.validate) {
        contradict(next, kind);
        continue;
      }
      const bool refines = contains(before.kinds, kind);
      const bool named = 1.0 - std::pow(taken.validate / before.validate, 2) >= kWorthNaming;
      if (!refines) found_.certain.push_back({group, probability, before.validate, taken.validate, named});
      if (!refines && !named) {
        set_aside(next, group);
        continue;
      }
      // Of a group no second one follows: the first stands for all.
      for (const std::string& other : group)
        if (other != kind || !term.can_repeat) excluded_.push_back(other);
      chosen_.push_back(std::move(term));
      found_.best = std::move(taken);
      return true;
    }
  }

  const EffortRows& rows_;
  std::vector<EffortTerm> base_, chosen_ = {};
  EffortRegression regression_;
  std::vector<std::string> excluded_;
  EvidenceFit left_ = {};
  EffortEvidence found_ = {};
};

/// Where the speed hardly changes, what is left of its changes follows the torque as much as it leads it: each record
/// has one speed a direction, and no acceleration.
void take_mean_speeds(EffortRows& rows) {
  for (const double sign : {1.0, -1.0}) {
    std::vector<double> sums(rows.signals.size(), 0.0), counts(rows.signals.size(), 0.0);
    const auto each = [&](auto use) {
      for (Eigen::Index k = 0; k < rows.w.size(); ++k)
        if (rows.w(k) * sign > 0.0) use(k, rows.record[static_cast<std::size_t>(k)]);
    };
    each([&](Eigen::Index k, std::size_t r) {
      sums[r] += rows.w(k);
      counts[r] += 1.0;
    });
    each([&](Eigen::Index k, std::size_t r) { rows.w(k) = sums[r] / counts[r]; });
  }
  rows.acceleration.setZero();
}

}  // namespace

std::optional<EffortEvidence> weigh_effects(const sim::DriveDescription& model, const RecordSet& training,
                                            const RecordSet& validation, const std::vector<std::string>& absent) {
  if (model.find("inertia") == nullptr || !has_inverse(sim::Drive(model))) return {};
  EffortRows rows = effort_rows(model, training, validation, kMostRows);
  if (rows.size() == 0) return {};
  if (rows.steady) take_mean_speeds(rows);
  const double effort = root_mean_square(rows, rows.effort, false);
  if (!(effort > 0.0) || !(root_mean_square(rows, rows.effort, true) > 0.0)) return {};
  rows.effort -= standing_effort(model, rows);
  Search search(model, rows, absent);
  if (!search.fit_base()) return {};
  // The level that usual sizes compare to; where nothing rubs, a twentieth of what the motor gives.
  constexpr double kLeastLevel = 0.05;
  const sim::Drive fitted(search.fitted_base().model);
  const double coulomb =
      std::max(0.5 * (fitted.friction[0].coulomb + fitted.friction[1].coulomb), kLeastLevel * effort);
  const EffortHypotheses hypotheses(model, rows, search.base(), rows.effort - search.fitted_base().residual, coulomb);
  return search.run(hypotheses);
}

}  // namespace host
