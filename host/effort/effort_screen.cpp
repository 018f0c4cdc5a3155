#include "host/effort/effort_screen.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/cancellation.hpp"
#include "host/effort/closest_form.hpp"
#include "host/effort/effort_hypotheses.hpp"
#include "host/effort/effort_waves.hpp"
#include "host/effort/hidden_pair.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/infer/posterior.hpp"
#include "sim/drive.hpp"

namespace host {

namespace {

constexpr int kMostRounds = 16;  // includes further waves of a kind; limits the time

void note_odds(ScreenedModel& model, double log_odds) {
  model.log_odds = log_odds;
  model.confidence = logistic(log_odds);
}

bool contains(const std::vector<std::string>& kinds, const std::string& kind) {
  return std::ranges::find(kinds, kind) != kinds.end();
}

class Search {
 public:
  /// Keeps references.
  Search(EffortScreen& screen, EffortRegression& regression, const std::vector<EffortTerm>& base,
         const std::vector<std::string>& absent)
      : screen_(screen), regression_(regression), base_(base), excluded_(absent) {}

  void run(const EffortHypotheses& hypotheses, std::size_t most_effects) {
    for (int round = 0; round < kMostRounds && screen_.chosen.size() < most_effects && step(hypotheses); ++round)
      throw_if_cancelled();
    drop_what_nothing_followed();
    screen_.memory_log_odds = hypotheses.memory_log_odds(left_, chosen_);
    drop_what_others_explain(hypotheses);
  }

 private:
  /// The best model with a further term, fitted to the training rows. No kind is listed twice.
  bool with(const EffortTerm& term, ScreenedModel& out) const {
    std::vector<const EffortTerm*> further = pointers_to(chosen_);
    further.push_back(&term);
    if (!regression_.fit(base_, further, out)) return false;
    const ScreenedModel& before = screen_.best();
    out.words = term.words;
    out.kinds = before.kinds;
    if (!contains(out.kinds, term.kind)) out.kinds.push_back(term.kind);
    return true;
  }

  /// The same with the closest form, from each start of its kind. False if that form stands in for another effect.
  bool with_closest(NextEffect& effect, ScreenedModel& out) const {
    if (!with(effect.term, out)) return false;
    if (!effect.term.neighbours) return true;
    std::vector<FittedForm> starts{{std::move(effect.term), std::move(out)}};
    for (EffortTerm& other : std::exchange(effect.others, {}))
      if (ScreenedModel tried; with(other, tried)) starts.push_back({std::move(other), std::move(tried)});
    FittedForm closest = closest_form(regression_, base_, chosen_, std::move(starts));
    effect.term = std::move(closest.term);
    out = std::move(closest.model);
    return !effect.term.is_itself || effect.term.is_itself(out.model);
  }

  /// The best model with each kind added, for the report and for `add`.
  std::vector<ScreenedModel> all_of(NextEffects& next) const {
    // Forms are refined only for kinds that may be named.
    std::vector<ScreenedModel> list;
    for (NextEffect& effect : next.effects) {
      ScreenedModel tried;
      const bool closest = effect.probability > kPossible || next.effects.size() == 1;
      if (!(closest ? with_closest(effect, tried) : with(effect.term, tried))) continue;
      if (tried.kinds.size() == screen_.best().kinds.size()) continue;  // further wave of a known effect
      tried.probability = effect.probability;
      note_odds(tried, effect.log_odds);
      list.push_back(std::move(tried));
    }
    return list;
  }

  /// Refuting an effect needs the same confidence as a claim, because chance can raise the validation error a little.
  bool is_refuted(const ScreenedModel& taken) const {
    return regression_.confidence(screen_.best(), taken) <= 1.0 - kClaimed;
  }

  /// The first kind of a group, after the leader, that held-back motions refute, so that it is not a rival. Null if
  /// there is none.
  NextEffect* refuted_rival(const std::vector<std::string>& group, NextEffects& next) const {
    for (std::size_t k = 1; k < group.size(); ++k) {
      NextEffect& rival = effect_of(next, group[k]);
      ScreenedModel taken;
      if (!is_there(group[k]) && (!with_closest(rival, taken) || is_refuted(taken))) return &rival;
    }
    return nullptr;
  }

  /// Ends a step. Kinds that were removed from the candidates get probability 0.
  void close_step(std::vector<ScreenedModel> list, const NextEffects& next) {
    for (ScreenedModel& tried : list) {
      const auto still = std::ranges::find(next.effects, tried.kinds.back(),
                                           [](const NextEffect& effect) { return effect.term.kind; });
      tried.probability = still == next.effects.end() ? 0.0 : still->probability;
    }
    screen_.steps.push_back(std::move(list));
  }

  /// Whether a fit explains enough of the error on validation rows.
  bool is_worth_naming(double before, double after) const {
    return host::is_worth_naming(before, after, screen_.base.validate);
  }
  bool is_worth_naming(const ScreenedModel& fitted) const {
    return is_worth_naming(screen_.best().validate, fitted.validate);
  }

  NextEffects next_beside(const EffortHypotheses& hypotheses, const std::vector<EffortTerm>& chosen,
                          const std::vector<std::string>& excluded) const {
    return hypotheses.next(chosen, screen_.rows.effort - screen_.best().residual, excluded,
                           [this](const EffortTerm& term) { return plain_error(term); });
  }

  NextEffects weigh(const EffortHypotheses& hypotheses) {
    NextEffects next = next_beside(hypotheses, chosen_, excluded_);
    left_ = next.fit;
    regression_.weigh(hypotheses.weights(left_));
    return next;
  }

  /// An unnamed effect is a rival while it predicts held-back motions better than the most probable effect.
  void weigh_unnamed(NextEffects& next) const {
    const auto is_unnamed = [](const NextEffect& effect) { return effect.term.kind == kNoName; };
    const auto unnamed = std::ranges::find_if(next.effects, is_unnamed);
    if (unnamed == next.effects.end()) return;
    const auto named = std::ranges::find_if_not(next.effects, is_unnamed);
    ScreenedModel without_name, with_name;
    const bool stands = with(unnamed->term, without_name) && is_worth_naming(without_name) &&
                        !(named != next.effects.end() && with_closest(*named, with_name) &&
                          with_name.validate <= without_name.validate);
    if (stands)
      leave_unnamed(next);
    else
      take_out(next, {kNoName});
  }

  /// Training error of a form beside the chosen ones, by least squares.
  std::optional<double> plain_error(const EffortTerm& term) const {
    ScreenedModel tried;
    if (contains(refused_waves_, term.words) || !with(term, tried)) return {};
    return tried.train;
  }

  /// Adds the most probable effect if it is certain, holds on validation rows and explains enough of the error; or the
  /// first of several effects that do so together. Returns false if there is none.
  bool step(const EffortHypotheses& hypotheses) {
    NextEffects all = weigh(hypotheses);
    weigh_unnamed(all);
    std::vector<ScreenedModel> list = all_of(all);
    put_in_place_what_is_contained(list, all);
    if (screen_.leaves_noise()) leave_nothing(all);
    // A certain effect that explains little is not a rival of one that explains much.
    std::vector<std::string> small;
    for (const ScreenedModel& tried : list)
      if (!is_worth_naming(tried)) small.push_back(tried.kinds.back());
    NextEffects next = all;
    take_out(next, small);
    take_out_needless_gap(list, next);
    if (take_one(next, all, list)) {
      to_be_followed_.clear();
      return true;
    }
    screen_.nothing = next.nothing;
    if (to_be_followed_.empty() && (take_small_ones_together(all, list) || take_one_of_two(hypotheses, all, list)))
      return true;
    for (const SmallOne& one : small_ones(std::move(all))) screen_.certain.push_back(one.certain);
    close_step(std::move(list), next);
    return false;
  }

  /// Replaces a gap that the encoder hardly resolves by a spring whose form is refined as much.
  void put_in_place_what_is_contained(std::vector<ScreenedModel>& list, NextEffects& next) const {
    const auto gap = std::ranges::find_if(next.effects, [](const auto& one) { return one.term.contained != nullptr; });
    if (gap == next.effects.end()) return;
    const std::string wide = gap->term.kind;
    NextEffect spring{.term = gap->term.contained(), .others = {}, .log_odds = gap->log_odds};
    for (const NextEffect& other : next.effects)
      if (other.term.kind == spring.term.kind) spring.others.push_back(other.term);
    ScreenedModel fitted;
    if (contains(excluded_, spring.term.kind) || !with_closest(spring, fitted)) return;
    const std::string narrow = spring.term.kind;
    give_place(next, wide, std::move(spring));
    fitted.probability = effect_of(next, narrow).probability;
    note_odds(fitted, effect_of(next, narrow).log_odds);
    std::erase_if(list, [&](const auto& one) { return one.kinds.back() == wide || one.kinds.back() == narrow; });
    list.push_back(std::move(fitted));
  }

  /// Removes the gap from the candidates unless it explains a sufficient part of the residual that the spring leaves.
  void take_out_needless_gap(const std::vector<ScreenedModel>& list, NextEffects& next) const {
    const auto of = [&](const char* kind) {
      return std::ranges::find_if(list, [&](const ScreenedModel& tried) { return tried.kinds.back() == kind; });
    };
    const auto spring = of("compliance"), gap = of("backlash");
    if (spring != list.end() && gap != list.end() && !is_worth_naming(spring->validate, gap->validate))
      take_out(next, {"backlash"});
  }

  /// Takes one candidate. Refuted ones are removed from the candidates and, permanently, from `all`.
  bool take_one(NextEffects& next, NextEffects& all, const std::vector<ScreenedModel>& list) {
    while (true) {
      double probability = 0.0;
      std::vector<std::string> group = certain_group(next, probability);
      if (group.empty()) return false;
      if (const NextEffect* rival = refuted_rival(group, next)) {
        const std::string refuted = rival->term.kind;
        refuse(refuted, all);
        take_out(next, {refuted});
        continue;
      }
      // If a further wave of an effect that has been found suffices, no second effect is needed.
      std::stable_partition(group.begin(), group.end(), [&](const std::string& kind) { return is_there(kind); });
      const std::string kind = group.front();
      NextEffect& effect = effect_of(next, kind);
      const std::string form = effect.term.words;
      ScreenedModel taken;
      if (!with_closest(effect, taken) || is_refuted(taken)) {
        if (is_there(kind))
          refuse_wave(form, next);
        else
          refuse(kind, all);
        take_out(next, {kind});
        continue;
      }
      if (!is_there(kind) && !is_worth_naming(taken)) {
        take_out(next, {kind});
        continue;
      }
      taken.probability = effect.probability;
      note_odds(taken, effect.log_odds);
      if (effect.term.can_repeat) taken.words = words_of_waves(taken.model, kind);
      if (is_there(kind))
        take_further_wave(kind, std::move(taken));
      else
        take_effect(group, probability, std::move(taken), list, next);
      keep(std::move(effect.term), group);
      return true;
    }
  }

  bool is_there(const std::string& kind) const { return contains(screen_.best().kinds, kind); }

  /// A wave that fails validation as one kind is not tried again as another kind.
  void refuse_wave(const std::string& form, NextEffects& next) {
    refused_waves_.push_back(form);
    std::vector<std::string> same;
    for (const NextEffect& effect : next.effects)
      if (effect.term.words == form) same.push_back(effect.term.kind);
    take_out(next, same);
  }

  void refuse(const std::string& kind, NextEffects& all) {
    excluded_.push_back(kind);
    take_out(all, {kind});
  }

  /// Of a group, only the first kind is added. It stands for the group and may have further waves.
  void keep(EffortTerm term, const std::vector<std::string>& group) {
    for (const std::string& other : group)
      if (other != term.kind || !term.can_repeat) excluded_.push_back(other);
    chosen_.push_back(std::move(term));
  }

  void take_further_wave(const std::string& kind, ScreenedModel taken) {
    std::ranges::find(screen_.certain, kind, [](const CertainEffect& found) { return found.group.front(); })->after =
        taken.validate;
    ScreenedModel& last = screen_.chosen.back();
    if (last.kinds.back() != kind) taken.words = last.words;
    taken.probability = last.probability;
    note_odds(taken, last.log_odds);
    last = std::move(taken);
  }

  void take_effect(const std::vector<std::string>& group, double probability, ScreenedModel taken,
                   std::vector<ScreenedModel> list, const NextEffects& next) {
    screen_.certain.push_back({group, probability, screen_.best().validate, taken.validate});
    std::erase_if(list, [&](const ScreenedModel& tried) { return tried.kinds == taken.kinds; });
    list.insert(list.begin(), taken);
    close_step(std::move(list), next);
    screen_.chosen.push_back(std::move(taken));
    screen_.tied.emplace_back(group.begin() + 1, group.end());
  }

  struct SmallOne {
    EffortTerm term;
    CertainEffect certain;
    double log_odds;
  };

  /// Effects that are certain beside all effects found, but each too small to be named.
  std::vector<SmallOne> small_ones(NextEffects all) {
    std::vector<SmallOne> small;
    while (true) {
      double probability = 0.0;
      const std::vector<std::string> group = certain_group(all, probability);
      if (group.empty()) return small;
      if (const NextEffect* rival = refuted_rival(group, all)) {
        refuse(std::string(rival->term.kind), all);
        continue;
      }
      NextEffect& effect = effect_of(all, group.front());
      ScreenedModel taken;
      if (!is_there(group.front()) && with_closest(effect, taken) && !is_refuted(taken))
        small.push_back({effect.term, {group, probability, screen_.best().validate, taken.validate}, effect.log_odds});
      take_out(all, group);
    }
  }

  /// Adds the first of several effects that mask each other: each alone explains too little to be named.
  bool take_small_ones_together(const NextEffects& all, const std::vector<ScreenedModel>& list) {
    NextEffects no_waves = all;
    // Many waves together fit any shape over the travel, so the first wave must be significant by itself.
    std::vector<std::string> waves;
    for (const NextEffect& effect : all.effects)
      if (effect.term.can_repeat) waves.push_back(effect.term.kind);
    take_out(no_waves, waves);
    std::vector<SmallOne> together = small_ones(std::move(no_waves));
    const auto fitted = [&](std::size_t without, ScreenedModel& out) {
      std::vector<const EffortTerm*> further = pointers_to(chosen_);
      for (std::size_t k = 0; k < together.size(); ++k)
        if (k != without) further.push_back(&together[k].term);
      return regression_.fit(base_, further, out);
    };
    // Removes the smallest effect until each is needed.
    for (bool dropped = true; dropped && together.size() > 1;) {
      ScreenedModel with_all;
      if (!fitted(together.size(), with_all)) return false;
      double least = HUGE_VAL;
      std::size_t smallest = 0;
      for (std::size_t k = 0; k < together.size(); ++k) {
        ScreenedModel without;
        const double left = fitted(k, without) ? without.validate : 0.0;
        if (left < least) smallest = k;
        least = std::min(least, left);
      }
      dropped = !is_worth_naming(least, with_all.validate);
      if (dropped) together.erase(together.begin() + static_cast<std::ptrdiff_t>(smallest));
    }
    if (together.size() < 2) return false;
    // The others follow in the next steps, each in the form that fits best beside the first.
    SmallOne& first = together.front();
    ScreenedModel taken;
    if (!with(first.term, taken)) return false;
    taken.probability = first.certain.probability;
    note_odds(taken, first.log_odds);
    take_effect(first.certain.group, first.certain.probability, std::move(taken), list, all);
    keep(std::move(first.term), first.certain.group);
    to_be_followed_ = first.certain.group.front();
    return true;
  }

  /// Adds one of two effects that mask each other, if the other is certain beside it.
  bool take_one_of_two(const EffortHypotheses& hypotheses, const NextEffects& all,
                       const std::vector<ScreenedModel>& list) {
    const NextEffect* beside = less_seen_of_two(regression_, base_, chosen_, screen_.best(), all,
                                                [this](const ScreenedModel& both) { return is_worth_naming(both); });
    if (beside == nullptr) return false;
    std::vector<EffortTerm> chosen = chosen_;
    chosen.push_back(beside->term);
    std::vector<std::string> excluded = excluded_;
    excluded.push_back(beside->term.kind);
    NextEffects next = next_beside(hypotheses, chosen, excluded);
    leave_unnamed(next);
    double probability = 0.0;
    const std::vector<std::string> group = certain_group(next, probability);
    ScreenedModel taken;
    if (group.empty() || next.effects.front().term.can_repeat || !with(next.effects.front().term, taken)) return false;
    taken.probability = next.effects.front().probability;
    note_odds(taken, next.effects.front().log_odds);
    take_effect(group, probability, std::move(taken), list, next);
    keep(next.effects.front().term, group);
    to_be_followed_ = group.front();
    return true;
  }

  /// The final model without a kind; empty if it cannot be fitted.
  std::optional<ScreenedModel> without(const std::string& kind, std::vector<EffortTerm>& others) const {
    others = chosen_;
    std::erase_if(others, [&](const EffortTerm& term) { return term.kind == kind; });
    ScreenedModel left;
    if (!regression_.fit(base_, pointers_to(others), left)) return {};
    const ScreenedModel& now = screen_.chosen.back();
    left.kinds = now.kinds;
    std::erase(left.kinds, kind);
    left.words = now.words;
    left.probability = now.probability;
    note_odds(left, now.log_odds);
    return left;
  }

  /// Discards the steps that included a kind.
  void drop(const std::string& kind, std::vector<EffortTerm> others, ScreenedModel left) {
    const auto at = std::ranges::find(screen_.chosen.back().kinds, kind) - screen_.chosen.back().kinds.begin();
    chosen_ = std::move(others);
    screen_.chosen.erase(screen_.chosen.begin() + at);
    screen_.tied.erase(screen_.tied.begin() + at);
    screen_.steps.erase(screen_.steps.begin() + at);
    if (!screen_.chosen.empty()) screen_.chosen.back() = std::move(left);
  }

  void drop_what_nothing_followed() {
    if (to_be_followed_.empty()) return;
    std::vector<EffortTerm> others;
    if (std::optional<ScreenedModel> left = without(to_be_followed_, others))
      drop(to_be_followed_, std::move(others), *std::move(left));
  }

  /// An effect that was found early may have stood for two effects that were found later.
  void drop_what_others_explain(const EffortHypotheses& hypotheses) {
    for (std::size_t k = 0; screen_.chosen.size() > 1 && k + 1 < screen_.chosen.size();) {
      const std::string kind = screen_.chosen.back().kinds[k];
      std::vector<EffortTerm> others;
      std::optional<ScreenedModel> left = without(kind, others);
      if (!left || hypotheses.log_evidence(others) < hypotheses.log_evidence(chosen_)) {
        ++k;
        continue;
      }
      std::erase_if(screen_.certain, [&](const CertainEffect& effect) { return effect.group.front() == kind; });
      drop(kind, std::move(others), *std::move(left));
    }
  }

  EffortScreen& screen_;
  EffortRegression& regression_;
  const std::vector<EffortTerm>& base_;
  std::vector<EffortTerm> chosen_ = {};
  std::vector<std::string> excluded_, refused_waves_ = {};
  std::string to_be_followed_ = {};  ///< chosen for its gain together with an effect that is not yet found
  EvidenceFit left_ = {};
};

}  // namespace

EffortScreen screen_effort(const sim::DriveDescription& model, const RecordSet& training, const RecordSet& validation,
                           std::size_t most_effects, const std::vector<std::string>& absent) {
  EffortScreen screen;
  if (model.find("inertia") == nullptr || !has_inverse(sim::Drive(model))) return screen;
  screen.rows = effort_rows(model, training, validation);
  if (screen.empty()) return screen;
  if (screen.rows.steady) take_mean_speeds(screen.rows);
  EffortRegression regression(model, screen.rows);
  screen.effort_train = root_mean_square(screen.rows, screen.rows.effort, false);
  screen.effort_validate = root_mean_square(screen.rows, screen.rows.effort, true);
  screen.rows.effort -= standing_effort(model, screen.rows);
  const std::vector<EffortTerm> base = base_terms(model, screen.rows);
  if (!(screen.effort_train > 0.0) || !(screen.effort_validate > 0.0) ||
      !regression.fit(base, {}, screen.base, &screen.held))
    return {};
  if (screen.rows.steady) screen.held.emplace_back("the speed hardly changes, so the inertia does not show");
  if (most_effects > 0) {
    // Scale of usual sizes. If there is no friction, it is a twentieth of the motor's torque or force.
    constexpr double kLeastLevel = 0.05;
    const sim::Drive fitted(screen.base.model);
    const double coulomb =
        std::max(0.5 * (fitted.friction[0].coulomb + fitted.friction[1].coulomb), kLeastLevel * screen.effort_train);
    const EffortHypotheses hypotheses(model, screen.rows, base, screen.rows.effort - screen.base.residual, coulomb,
                                      absent);
    Search(screen, regression, base, absent).run(hypotheses, most_effects);
  }
  if (screen.chosen.empty()) {
    EffortRows swapped = screen.rows;
    swapped.judges.flip();
    ScreenedModel alone;
    if (EffortRegression(model, swapped).fit(base, {}, alone)) screen.judge_alone = std::move(alone);
  }
  screen.repeatable = repeatability(screen.rows, screen.best().residual);
  return screen;
}

std::optional<ScreenedModel> refitted_with(const EffortScreen& screen, const EffortTerm& term) {
  const ScreenedModel& now = screen.best();
  // The other terms are fitted again only if the regression has a term for every effect of the model.
  const bool whole = screen.chosen.empty() || has_linear_form(now.model);
  const EffortRegression regression(now.model, screen.rows, whole ? screen.rows.effort : now.residual);
  ScreenedModel with;
  if (!regression.fit(whole ? base_terms(now.model, screen.rows) : std::vector<EffortTerm>{}, {&term}, with)) return {};
  with.kinds = now.kinds;
  with.kinds.push_back(term.kind);
  with.words = term.words;
  with.train = root_mean_square(screen.rows, with.residual, false) / screen.effort_train;
  with.validate = root_mean_square(screen.rows, with.residual, true) / screen.effort_validate;
  with.confidence = regression.confidence(now, with);
  return with;
}

}  // namespace host
