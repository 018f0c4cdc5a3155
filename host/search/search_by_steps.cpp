#include "host/search/search_by_steps.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "host/effort/second_mass_terms.hpp"
#include "host/fit/model_fit.hpp"
#include "host/parallel.hpp"
#include "host/search/balance_odds.hpp"
#include "host/search/explained_share.hpp"
#include "host/search/further_waves.hpp"
#include "host/search/physical_range.hpp"
#include "sim/catalogue.hpp"
#include "sim/second_mass.hpp"

namespace host {

namespace {

/// An effect that helps only at a bound of its physical range, or far from the recorded travel, stands in for another
/// one. No further effect is added to it.
bool is_physical(const Candidate& candidate, const PreparedSets& sets) {
  return unphysical_parameters(candidate.model, candidate.kinds, sets.training).empty();
}

struct Errors {
  double training, validation;

  Errors(const sim::DriveDescription& model, const PreparedSets& sets)
      : training(error_of(sim::Drive(model), sets.training).combined),
        validation(error_of(sim::Drive(model), sets.validation).combined) {}
};

/// A third effect is searched for if the pair explains two fifths of the error and leaves more than a complete model
/// would.
bool promises_a_third(const Errors& base, const Errors& pair) {
  constexpr double kMost = 0.4;
  return pair.validation > kExplained && explained_share(base.training, pair.training) > kMost &&
         explained_share(base.validation, pair.validation) > kMost;
}

constexpr FitOptions kRefit{.most_iterations = 12, .least_gain = 3e-4, .most_steps = 8e6};

sim::DriveDescription without(const sim::DriveDescription& model, const std::string& kind, const RecordSet& training) {
  sim::DriveDescription rest = model;
  std::erase_if(rest.effects, [&](const sim::EffectEntry& entry) { return entry.kind == kind; });
  return fit_model(rest, training, kRefit).model;
}

/// While the axis slides, a constant force or an offset of the command is equivalent to a difference of friction
/// between the directions. This changes the friction accordingly in one step; a fit by gradients would stay in a nearby
/// local minimum. Empty for other effects and other forms of friction.
std::optional<sim::DriveDescription> handed_to_friction(const sim::DriveDescription& model, const std::string& kind) {
  double force = 0.0;
  if (kind == "constant_torque") force = model.find(kind)->at("torque");
  if (kind == "dac_offset") force = model.find(kind)->at("offset") * model.data.effort_per_volt();
  sim::DriveDescription other = model;
  if (force == 0.0) return {};
  for (const auto& [friction, level] : {std::pair("coulomb", ""), std::pair("stribeck", "static_")}) {
    sim::EffectEntry* entry = other.find(friction);
    if (entry == nullptr) continue;
    const std::string positive = std::string(level) + "positive", negative = std::string(level) + "negative";
    if (!entry->has(positive) || !entry->has(negative) || !entry->held.empty()) return {};
    entry->parameters[positive] -= force;
    entry->parameters[negative] -= force;
    if (entry->at(positive) <= 0.0 || entry->at(negative) >= 0.0) return {};
  }
  return other;
}

/// The model without one of its effects, with the fitted values of the others.
sim::DriveDescription without_or_handed(const Candidate& whole, const std::string& kind, const PreparedSets& sets) {
  sim::DriveDescription model = without(whole.model, kind, sets.training);
  const std::optional<sim::DriveDescription> other = handed_to_friction(whole.model, kind);
  if (!other) return model;
  sim::DriveDescription handed = without(*other, kind, sets.training);
  const auto left = [&](const sim::DriveDescription& of) { return error_of(sim::Drive(of), sets.training).robust; };
  return left(handed) < left(model) ? handed : model;
}

bool is_as_good(const sim::DriveDescription& model, const Errors& with, const PreparedSets& sets) {
  const Errors errors(model, sets);
  return errors.training < kAsGood * with.training && errors.validation < kAsGood * with.validation;
}

/// Whether the base was stuck in a local minimum: with a start from the fit of one of the best effects, the base
/// reaches the same training error without that effect. If so, the base keeps that fit.
bool base_was_stuck(PreparedSets& sets, const std::vector<Candidate>& singles) {
  constexpr double kBetter = 0.98;
  constexpr std::size_t kTried = 3;
  const double before = Errors(sets.base, sets).training;
  for (const Candidate& single : std::span(singles).first(std::min(kTried, singles.size()))) {
    const sim::DriveDescription base = without_or_handed(single, single.kinds.back(), sets);
    const double here = Errors(base, sets).training;
    if (here > kBetter * before || here > kAsGood * Errors(single.model, sets).training) continue;
    sets.base = base;
    return true;
  }
  return false;
}

/// Refits several effects without each of them in turn. The last one may have made an earlier one unnecessary, or may
/// only have moved the fit out of a local minimum.
std::vector<Candidate> without_what_is_needless(const Candidate& whole, const PreparedSets& sets) {
  const Errors with(whole.model, sets);
  std::vector<std::optional<Candidate>> shorter(whole.kinds.size());
  for_each_in_parallel(shorter.size(), [&](std::size_t k) {
    const std::string& kind = whole.kinds[k];
    const sim::DriveDescription model = without_or_handed(whole, kind, sets);
    if (!is_as_good(model, with, sets)) return;
    std::vector<std::string> kinds = whole.kinds;
    std::erase(kinds, kind);
    shorter[k] = judged(kinds, model, sets.training, sets.validation);
  });
  std::vector<Candidate> found;
  for (std::optional<Candidate>& one : shorter)
    if (one) found.push_back(*std::move(one));
  return found;
}

/// Appends all entries of a kind: a periodic effect may have several waves.
void append_entries(const sim::DriveDescription& from, const std::string& kind, sim::DriveDescription& to) {
  for (const sim::EffectEntry& entry : from.effects)
    if (entry.kind == kind) to.effects.push_back(entry);
}

/// The candidate with one of its earlier effects replaced by an effect with which it is often confused, if that also
/// helps alone. The last effect was searched only beside the earlier ones.
std::vector<Candidate> with_one_exchanged(const Candidate& whole, const std::vector<Candidate>& singles,
                                          const PreparedSets& sets) {
  struct Exchange {
    std::vector<std::string> kinds;
    sim::DriveDescription alone, exchanged;  // on the base of the other effect alone, and on the base of the whole
  };
  std::vector<Exchange> exchanges;
  for (const std::string& kind : std::span(whole.kinds).first(whole.kinds.size() - 1)) {
    const std::vector<std::string_view>& relatives = sim::find_effect(kind)->confused_with;
    for (const Candidate& single : singles) {
      const std::string& other = single.kinds.back();
      if (std::ranges::find(whole.kinds, other) != whole.kinds.end() || !is_physical(single, sets) ||
          std::ranges::find(relatives, other) == relatives.end())
        continue;
      Exchange exchange{{other}, single.model, whole.model};
      std::erase_if(exchange.exchanged.effects, [&](const sim::EffectEntry& entry) { return entry.kind == kind; });
      append_entries(single.model, other, exchange.exchanged);
      for (const std::string& kept : whole.kinds) {
        if (kept == kind) continue;
        append_entries(whole.model, kept, exchange.alone);
        exchange.kinds.push_back(kept);
      }
      exchanges.push_back(std::move(exchange));
    }
  }
  std::vector<Candidate> found(exchanges.size());
  for_each_in_parallel(exchanges.size(), [&](std::size_t k) {
    const auto& [kinds, alone, exchanged] = exchanges[k];
    const FitResult one = fit_model(alone, sets.training, kRefit);
    // The new effect still has the value that it had alone.
    const FitResult two = fit_model(fit_model(exchanged, sets.training, kOwnSize).model, sets.training, kRefit);
    found[k] = judged(kinds, (one.robust < two.robust ? one : two).model, sets.training, sets.validation);
  });
  return found;
}

/// Divides the friction of a drive with a second mass between motor and load if that is better: friction on the motor
/// side can make a spring look like a gap. Both forms are fitted to the whole training set from the same values, so
/// that the parameter is not credited with what the fit alone gains.
void split_friction(std::vector<Candidate>& candidates, const PreparedSets& sets) {
  constexpr double kStart = 0.9, kBetter = 0.02;
  for (Candidate& candidate : candidates) {
    sim::DriveDescription model = candidate.model;
    const auto second = std::ranges::find_if(
        model.effects, [](const sim::EffectEntry& entry) { return sim::is_second_mass(entry.kind); });
    if (second == model.effects.end() || second->has("load_friction")) continue;
    const auto fitted = [&](const sim::DriveDescription& start) {
      return judged(candidate.kinds, fit_model(start, sets.training, kRefit).model, sets.training, sets.validation);
    };
    Candidate whole = fitted(model);
    second->parameters["load_friction"] = kStart;
    Candidate split = fitted(model);
    if (whole.log_loss() < candidate.log_loss()) candidate = std::move(whole);
    if (split.training.log_loss < candidate.training.log_loss - kBetter && split.log_loss() < candidate.log_loss() &&
        is_physical(split, sets))
      candidate = std::move(split);
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::log_loss);
}

/// Continues the fit of a candidate until it converges, over its own noise floors. In the search the fit ended at its
/// budget, over the noise floors of another model. Where those were high, the period of a cogging stayed 0.06 % off. A
/// fit is taken only if log loss and squared error both fall, because larger noise floors alone can lower the log loss.
void finish_fit(Candidate& candidate, const PreparedSets& sets) {
  constexpr int kMostRounds = 4;
  constexpr double kSettled = 0.005;  // of the log loss: half a percent of the error
  for (int round = 0; round < kMostRounds; ++round) {
    RecordSet own = sets.training;
    renew_floors(own, candidate.model);
    Candidate again =
        judged(candidate.kinds, fit_model(candidate.model, own, kRefit).model, sets.training, sets.validation);
    const double gain = candidate.training.log_loss - again.training.log_loss;
    if (gain <= 0.0 || again.training.combined > candidate.training.combined) break;
    candidate = std::move(again);
    if (gain < kSettled) break;
  }
}

/// Of candidates with the same effects, keeps the best. Best first.
void keep_best_of_each(std::vector<Candidate>& candidates) {
  std::ranges::stable_sort(candidates, {}, &Candidate::log_loss);
  std::vector<Candidate> best;
  for (Candidate& candidate : candidates)
    if (std::ranges::none_of(
            best, [&](const Candidate& other) { return std::ranges::is_permutation(other.kinds, candidate.kinds); }))
      best.push_back(std::move(candidate));
  candidates = std::move(best);
}

/// A spring is a gap of width zero, so every gap is compared with a spring that is fitted equally well. The spring
/// replaces the gap if the encoder does not show the gap, or if the spring predicts the records at least as well. If
/// `absent` contains the spring, nothing is replaced. Of two candidates with the same effects, the better one remains.
void compare_with_springs(std::vector<Candidate>& candidates, const PreparedSets& sets) {
  constexpr double kHardly = 0.02;  // the gap, with one parameter more, is 1 % better on each set
  if (std::ranges::find(sets.absent, "compliance") != sets.absent.end()) return;
  std::vector<Candidate> springs;
  std::erase_if(candidates, [&](const Candidate& candidate) {
    sim::DriveDescription model = candidate.model;
    sim::EffectEntry* gap = model.find("backlash");
    if (gap == nullptr) return false;
    const bool is_unseen = gap->at("gap") < least_gap(model.data);
    gap->kind = "compliance";
    gap->parameters.erase("gap");
    // The damping of a hard contact is higher than that of any spring in a drive, so the spring starts with its usual
    // damping.
    gap->parameters["damping_ratio"] = sim::find_effect("compliance")->parameter("damping_ratio")->starts.front();
    std::vector<std::string> kinds = candidate.kinds;
    std::ranges::replace(kinds, "backlash", "compliance");
    springs.push_back(judged(kinds, fit_model(model, sets.training, kRefit).model, sets.training, sets.validation));
    return is_unseen || springs.back().log_loss() <= candidate.log_loss() + kHardly;
  });
  if (springs.empty()) return;
  std::ranges::move(springs, std::back_inserter(candidates));
  keep_best_of_each(candidates);
}

/// Exchanges effects of the best candidate. If that is unphysical, as a voltage limit that stands for one of the
/// current, those of the best physical one as well.
void add_exchanged(std::vector<Candidate>& candidates, const std::vector<Candidate>& singles,
                   const PreparedSets& sets) {
  const auto physical = std::ranges::find_if(candidates, [&](const Candidate& one) { return is_physical(one, sets); });
  std::vector<Candidate> exchanged;
  for (auto whole = candidates.begin(); whole != candidates.end(); ++whole)
    if (whole == candidates.begin() || whole == physical)
      std::ranges::move(with_one_exchanged(*whole, singles, sets), std::back_inserter(exchanged));
  compare_with_springs(exchanged, sets);
  std::ranges::move(exchanged, std::back_inserter(candidates));
  std::ranges::stable_sort(candidates, {}, &Candidate::log_loss);
}

/// The single effects to which a further one is added: the best physical one and, if it is another, the best of those
/// that the force balance holds to be present. An effect that the balance cannot show, such as a gain of the
/// tachometer, may explain more of the motion than the effect that the balance shows, and then takes the base to where
/// that one cannot be found.
std::vector<Candidate> to_be_extended(const std::vector<Candidate>& singles, const PreparedSets& sets,
                                      const EffortScreen* balance) {
  std::vector<std::string> probable;
  if (balance != nullptr) probable = probable_kinds(*balance, {});
  std::vector<Candidate> leaders;
  for (const Candidate& single : singles) {
    if (!is_physical(single, sets)) continue;
    const bool is_probable = std::ranges::find(probable, single.kinds.back()) != probable.end();
    if (leaders.empty() || is_probable) leaders.push_back(single);
    if (is_probable) break;
  }
  return leaders;
}

}  // namespace

Findings search_by_steps(PreparedSets& sets, const ShareDone& progress, SearchEffort effort) {
  Findings found;
  std::vector<std::string> excluded = sets.absent;
  effort.absent = &excluded;
  const auto physical = [&sets](const Candidate& candidate) { return is_physical(candidate, sets); };
  const auto search = [&](const sim::DriveDescription& model, const std::vector<std::string>& kinds, double from,
                          double to) {
    sim::DriveDescription before = model;
    hold_further_waves(before, sets.base, kinds, true);
    std::vector<Candidate> candidates =
        search_candidates(before, kinds, sets.training, sets.validation, part_of(progress, from, to), effort);
    split_friction(candidates, sets);
    compare_with_springs(candidates, sets);
    if (!kinds.empty()) add_exchanged(candidates, found.singles, sets);
    const auto best = std::ranges::find_if(candidates, physical);
    if (best != candidates.end()) add_further_waves(*best, sets);
    for (Candidate& candidate : candidates) hold_further_waves(candidate.model, sets.base, candidate.kinds, false);
    if (best != candidates.end()) finish_fit(*best, sets);
    std::ranges::stable_sort(candidates, {}, &Candidate::log_loss);
    return candidates;
  };
  const auto renew = [&sets](const sim::DriveDescription& model) {
    renew_floors(sets.training, model);
    renew_floors(sets.validation, model);
  };
  const auto search_singles = [&](double from, double to) {
    found.singles = search(sets.base, {}, from, to);
    if (!found.singles.empty()) renew(found.singles.front().model);
  };
  search_singles(0.0, 0.4);
  if (!found.singles.empty() && base_was_stuck(sets, found.singles)) search_singles(0.4, 0.5);
  if (found.singles.empty()) return found;
  for (const Candidate& candidate : found.singles)
    if (!is_physical(candidate, sets)) excluded.push_back(candidate.kinds.back());
  const std::vector<Candidate> leaders = to_be_extended(found.singles, sets, effort.balance);
  if (leaders.empty() || Errors(leaders.front().model, sets).validation <= kExplained) return found;
  const double share = 0.3 / static_cast<double>(leaders.size());
  for (double from = 0.5; const Candidate& single : leaders) {
    std::ranges::move(search(single.model, single.kinds, from, from + share), std::back_inserter(found.pairs));
    from += share;
  }
  keep_best_of_each(found.pairs);
  const auto pair = std::ranges::find_if(found.pairs, physical);
  if (pair == found.pairs.end()) return found;
  renew(pair->model);
  if (std::vector<Candidate> shorter = without_what_is_needless(*pair, sets); !shorter.empty()) {
    for (Candidate& better : shorter) {
      std::erase_if(found.singles, [&](const Candidate& stuck) { return stuck.kinds == better.kinds; });
      found.singles.push_back(std::move(better));
    }
    std::ranges::stable_sort(found.singles, {}, &Candidate::log_loss);
    if (Errors(found.singles.front().model, sets).validation <= kExplained) {
      found.pairs.clear();
      return found;
    }
  }
  if (!promises_a_third(Errors(sets.base, sets), Errors(pair->model, sets))) return found;
  found.triples = search(pair->model, pair->kinds, 0.8, 1.0);
  const auto triple = std::ranges::find_if(found.triples, physical);
  if (triple == found.triples.end()) return found;
  std::ranges::move(without_what_is_needless(*triple, sets), std::back_inserter(found.triples));
  return found;
}

}  // namespace host
