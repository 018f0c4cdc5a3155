#include "host/effort/effort_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "host/cancellation.hpp"
#include "host/effort/closest_form.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/infer/posterior.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

/// Further waves of a kind included.
constexpr int kMostSteps = 16;
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
  bool with(const EffortTerm& term, ScreenedModel& out) const {
    std::vector<const EffortTerm*> further;
    for (const EffortTerm& before : chosen_) further.push_back(&before);
    further.push_back(&term);
    if (!regression_.fit(base_, further, out)) return false;
    out.words = term.words;
    out.kinds = found_.best.kinds;
    if (!contains(out.kinds, term.kind)) out.kinds.push_back(term.kind);
    return true;
  }

  /// The same with the form refined, from each start of its kind: the one that leaves least of the training rows.
  bool with_closest(NextEffect& effect, ScreenedModel& out) const {
    if (!with(effect.term, out)) return false;
    if (!effect.term.neighbours) return true;
    effect.term = closest_form(regression_, base_, chosen_, std::move(effect.term), out);
    for (EffortTerm& start : effect.others) {
      ScreenedModel tried;
      if (!with(start, tried)) continue;
      EffortTerm refined = closest_form(regression_, base_, chosen_, std::move(start), tried);
      if (tried.train >= out.train) continue;
      out = std::move(tried);
      effect.term = std::move(refined);
    }
    effect.others.clear();
    return true;
  }

  /// Takes kinds out of what may come next; the others share their probability.
  static void take_out(NextEffects& next, const std::vector<std::string>& kinds) {
    std::erase_if(next.effects, [&](const NextEffect& effect) { return contains(kinds, effect.term.kind); });
    double sum = next.nothing;
    for (const NextEffect& effect : next.effects) sum += effect.probability;
    next.nothing = sum > 0.0 ? next.nothing / sum : 1.0;
    for (NextEffect& effect : next.effects) effect.probability = sum > 0.0 ? effect.probability / sum : 0.0;
  }

  /// Motions that no fit has seen have the last word: they must be more probable with the effect, and lie nearer to a
  /// model that has it.
  bool is_refuted(const EffortHypotheses& hypotheses, const EffortTerm& term, const ScreenedModel& taken) const {
    if (taken.validate >= found_.best.validate) return true;
    std::vector<EffortTerm> all = chosen_;
    all.push_back(term);
    return hypotheses.held_back_log_odds(all) < 0.0;
  }

  /// Whether a fit takes enough of the squared error on validation rows: of what is left, and of what the base leaves.
  bool is_worth_naming(const ScreenedModel& fitted) const {
    const double before = std::pow(found_.best.validate, 2), taken = before - std::pow(fitted.validate, 2);
    return taken >= kWorthNaming * before && taken >= kWorthOfAll * std::pow(found_.base.validate, 2);
  }

  bool is_there(const std::string& kind) const { return contains(found_.best.kinds, kind); }

  static NextEffect& effect_of(NextEffects& next, const std::string& kind) {
    return *std::ranges::find(next.effects, kind, [](const NextEffect& other) { return other.term.kind; });
  }

  NextEffects weigh(const EffortHypotheses& hypotheses) {
    NextEffects next = hypotheses.next(chosen_, rows_.effort - found_.best.residual, excluded_,
                                       [this](const EffortTerm& term) -> std::optional<double> {
                                         ScreenedModel tried;
                                         if (contains(refused_waves_, term.words) || !with(term, tried)) return {};
                                         return tried.train;
                                       });
    left_ = next.fit;
    regression_.weigh(hypotheses.weights(left_));
    return next;
  }

  /// Kinds of which no form takes enough to be named. What is there, but takes hardly anything, is no rival of what
  /// takes much.
  std::vector<std::string> small_ones(NextEffects& next) const {
    constexpr double kPossible = 1e-4;
    std::vector<std::string> small;
    for (NextEffect& effect : next.effects) {
      ScreenedModel tried;
      const bool fits = effect.probability > kPossible ? with_closest(effect, tried) : with(effect.term, tried);
      if (!is_there(effect.term.kind) && (!fits || !is_worth_naming(tried))) small.push_back(effect.term.kind);
    }
    return small;
  }

  /// A wave that does not hold under one name is no other effect.
  void refuse_wave(const std::string& form, NextEffects& next) {
    refused_waves_.push_back(form);
    std::vector<std::string> same;
    for (const NextEffect& effect : next.effects)
      if (effect.term.words == form) same.push_back(effect.term.kind);
    take_out(next, same);
  }

  /// Adds the most probable effect that is certain, holds on validation rows and takes enough of the error; false where
  /// none does.
  bool step(const EffortHypotheses& hypotheses) {
    NextEffects all = weigh(hypotheses);
    const std::vector<std::string> small = small_ones(all);
    NextEffects next = all;
    take_out(next, small);
    while (true) {
      double probability = 0.0;
      std::vector<std::string> group = certain_group(next, probability);
      found_.nothing = next.nothing;
      if (group.empty()) {
        list_small_ones(hypotheses, std::move(all));
        return false;
      }
      // Where an effect that is there may have another wave, no second one is needed.
      std::stable_partition(group.begin(), group.end(), [&](const std::string& kind) { return is_there(kind); });
      const std::string kind = group.front();
      NextEffect& effect = effect_of(next, kind);
      const std::string form = effect.term.words;
      ScreenedModel taken;
      if (!with_closest(effect, taken) || is_refuted(hypotheses, effect.term, taken)) {
        if (is_there(kind)) {
          refuse_wave(form, next);
        } else {
          excluded_.push_back(kind);
          take_out(all, {kind});
        }
        take_out(next, {kind});
        continue;
      }
      if (is_there(kind))
        std::ranges::find(found_.certain, kind, [](const CertainEffect& found) { return found.group.front(); })->after =
            taken.validate;
      else
        found_.certain.push_back({group, probability, found_.best.validate, taken.validate, true});
      // Of a group no second one follows: the first stands for all.
      for (const std::string& other : group)
        if (other != kind || !effect.term.can_repeat) excluded_.push_back(other);
      chosen_.push_back(std::move(effect.term));
      found_.best = std::move(taken);
      return true;
    }
  }

  /// Effects that are certain beside all that was found, but too small to be named.
  void list_small_ones(const EffortHypotheses& hypotheses, NextEffects all) {
    while (true) {
      double probability = 0.0;
      const std::vector<std::string> group = certain_group(all, probability);
      if (group.empty()) return;
      NextEffect& effect = effect_of(all, group.front());
      ScreenedModel taken;
      if (!is_there(group.front()) && with_closest(effect, taken) && !is_refuted(hypotheses, effect.term, taken))
        found_.certain.push_back({group, probability, found_.best.validate, taken.validate, false});
      take_out(all, group);
    }
  }

  const EffortRows& rows_;
  std::vector<EffortTerm> base_, chosen_ = {};
  EffortRegression regression_;
  std::vector<std::string> excluded_, refused_waves_ = {};
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
  EffortRows rows = effort_rows(model, training, validation);
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
