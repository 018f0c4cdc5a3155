#include "host/diagnose/candidate_search.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>

#include "host/diagnose/candidate_starts.hpp"
#include "host/diagnose/model_fit.hpp"
#include "host/diagnose/pattern_search.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/parallel.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// A candidate gets a serious fit only if its first fit lowers the training error to this share.
constexpr double kPromise = 0.98;

/// Candidates with an error of more than this multiple of the best one after the first look: only a few get a serious
/// fit, and none of those that need many small integration steps.
constexpr double kOutOfSight = 2.0;

/// Candidates within this factor of the best after the serious fits enter the final comparison.
constexpr double kClose = 1.5;

/// Two starts of one effect are both fitted further while the ratio of their errors is below this.
constexpr double kOpenRace = 1.25;

/// A drive with one integrator step per sample needs at most a third of these budgets. So a resonance of 200 Hz at 1
/// kHz (five steps per sample) still gets as many passes as most fits take. All fits of a search together take at most
/// some 400 million steps.
constexpr FitOptions kFirstLook{.most_iterations = 7, .least_gain = 1e-3, .most_steps = 8e6};
constexpr FitOptions kSeriousFit{.most_iterations = 12, .least_gain = 3e-4, .most_steps = 8e6};
constexpr FitOptions kLastWord{.most_iterations = 12, .least_gain = 3e-5, .most_steps = 20e6};
/// Budget for each start near a finalist: enough to find the deepest local minimum.
constexpr FitOptions kTryout{.most_iterations = 7, .least_gain = 1e-3, .most_steps = 2.5e6};
constexpr std::size_t kBestOfTryout = 4;
constexpr int kFirstSteps = 3;  // of each start, before the better ones are fitted further
/// If the base itself needs many small steps, so does every candidate. Each candidate then gets this share of its
/// budget.
constexpr double kCostlyPart = 0.4;
/// Least number of passes for a useful fit: six Jacobians of some eight parameters.
constexpr double kLeastPasses = 50.0;

/// The set with about this many windows in use, spread evenly over the records.
RecordSet thinned(const RecordSet& set, std::size_t windows) {
  RecordSet thin = set;
  thin.stride = 1;
  thin.stride = std::max<std::size_t>(1, thin.used_windows() / windows);
  return thin;
}

/// The set with so few windows in use that the budget suffices for kLeastPasses passes, but at least ten windows.
RecordSet affordable(const RecordSet& set, const sim::DriveDescription& model, const FitOptions& options) {
  constexpr std::size_t kLeastWindows = 10;
  const double share = kLeastPasses * steps_of(sim::Drive(model), set) / options.most_steps;
  RecordSet thin = set;
  if (share > 1.0)
    thin.stride = std::clamp(static_cast<std::size_t>(std::ceil(share * static_cast<double>(set.stride))), set.stride,
                             std::max(set.stride, set.stride * set.used_windows() / kLeastWindows));
  return thin;
}

struct Start {
  const sim::EffectInfo* info;
  sim::DriveDescription model;
  double error = HUGE_VAL;                         ///< error relative to the base's
  bool scanned = false;                            ///< the best of many starts, found by a scan
  bool balanced = false;                           ///< fitted by the force balance
  bool cut_short = false;                          ///< a fit ended at its budget
  sim::EffectEntry effect = model.effects.back();  ///< before any fit

  /// Takes over the result of a fit.
  void take(const FitResult& fit) {
    model = fit.model;
    cut_short = cut_short || fit.cut_short;
  }
};

/// Noise floors depend on the model that propagates the uncertainty of a restart. A model with presliding, a second
/// mass or a gap propagates it differently from the base, so such a candidate and the base are compared over the
/// candidate's own noise floors.
bool needs_own_floors(const sim::DriveDescription& model) {
  const sim::Drive drive(model);
  return drive.has_second_mass() || drive.bristles.has_value();
}

/// The set with the noise floors over which a model is compared.
RecordSet suited_to(const sim::DriveDescription& model, const RecordSet& shared) {
  RecordSet own = shared;
  if (needs_own_floors(model)) renew_floors(own, model);
  return own;
}

/// Fits a start on a set and stores its error relative to the base.
void fit_start(Start& start, const sim::DriveDescription& base, const RecordSet& shared, double base_error,
               const FitOptions& options) {
  const RecordSet set = affordable(shared, start.model, options);
  if (set.stride == shared.stride && (!needs_own_floors(start.model) || needs_own_floors(base))) {
    const FitResult fit = fit_model(start.model, set, options);
    start.take(fit);
    start.error = fit.robust / base_error;
    return;
  }
  const RecordSet own = suited_to(start.model, set);
  const FitResult fit = fit_model(start.model, own, options);
  start.take(fit);
  start.error = fit.robust / error_of(sim::Drive(base), own).robust;
}

/// An effect with more starts than this is scanned: each start is evaluated unfitted, and only the best are fitted,
/// first by a search without gradients.
constexpr std::size_t kMostStarts = 6;
constexpr std::size_t kBestOfScan = 2;
/// Largest unfitted error, relative to the base, of a start that is fitted. A slightly wrong second mass is worse than
/// none: the starts that found a gap beside asymmetric friction began at 1.17 and ended at 0.7.
constexpr double kWorstOfScan = 1.25;

/// Error of an unfitted start relative to the base.
double left_at(const sim::DriveDescription& start, const sim::DriveDescription& base, const RecordSet& shared) {
  const RecordSet own = suited_to(start, shared);
  return error_of(sim::Drive(start), own).robust / error_of(sim::Drive(base), own).robust;
}

void scan(std::vector<Start>& starts, const sim::DriveDescription& base, const RecordSet& set) {
  for (Start& start : starts) {
    start.error = left_at(start.model, base, set);
    start.scanned = true;
  }
  std::ranges::stable_sort(starts, {}, &Start::error);
  starts.resize(kBestOfScan, starts.front());
  std::erase_if(starts, [](const Start& start) { return start.error > kWorstOfScan; });
  for (Start& start : starts)
    start.model = pattern_search(start.model, suited_to(start.model, affordable(set, start.model, kSeriousFit)),
                                 kSeriousFit.most_steps);
}

}  // namespace

SearchEffort SearchEffort::over(double window_s) const {
  const auto scaled = [&](std::size_t windows) {
    return static_cast<std::size_t>(static_cast<double>(windows) * kWindow_s / window_s);
  };
  SearchEffort effort = *this;
  effort.coarse_windows = scaled(coarse_windows);
  effort.medium_windows = scaled(medium_windows);
  effort.final_windows = scaled(final_windows);
  return effort;
}

namespace {

/// Whether the fit raised the static friction to more than three times the given value because of a single breakaway.
/// This is a local minimum that may no longer exist with other values of the other parameters.
bool static_friction_ran_away(const sim::DriveDescription& fitted, const sim::DriveDescription& given) {
  constexpr double kFar = 3.0;
  const sim::EffectEntry *before = given.find("stribeck"), *after = fitted.find("stribeck");
  return before != nullptr && after != nullptr && std::ranges::any_of(before->parameters, [&](const auto& parameter) {
           const auto& [id, value] = parameter;
           return id.starts_with("static") && std::abs(after->at(id)) > kFar * std::abs(value);
         });
}

}  // namespace

sim::DriveDescription fit_base(const sim::DriveDescription& given, const RecordSet& training) {
  // From the given values, and with the inertia 25 % higher or lower and friction changed in the opposite sense.
  constexpr std::array kFactors{1.0, 1.25, 0.8};
  std::vector<sim::DriveDescription> starts(kFactors.size(), given);
  for (std::size_t k = 1; k < kFactors.size(); ++k) {
    for (const auto& [kind, factor] : {std::pair("inertia", kFactors[k]), std::pair("coulomb", 1.0 / kFactors[k])})
      if (sim::EffectEntry* entry = starts[k].find(kind))
        for (auto& [id, value] : entry->parameters)
          if (!entry->held.contains(id)) value *= factor;
  }
  const double window_s = training.records.front().prepared.window_s();
  const RecordSet thin = thinned(training, SearchEffort{}.over(window_s).medium_windows);
  std::vector<FitResult> results(starts.size());
  for_each_in_parallel(starts.size(), [&](std::size_t k) {
    results[k] = fit_model(starts[k], affordable(thin, starts[k], kSeriousFit), kSeriousFit);
  });
  FitResult best = *std::ranges::min_element(results, {}, &FitResult::robust);
  if (static_friction_ran_away(best.model, given)) {
    sim::DriveDescription again = best.model;
    *again.find("stribeck") = *given.find("stribeck");
    FitResult back = fit_model(again, affordable(thin, again, kSeriousFit), kSeriousFit);
    if (back.robust < best.robust) best = std::move(back);
  }
  const RecordSet last = thinned(training, SearchEffort{}.over(window_s).final_windows);
  return fit_model(best.model, affordable(last, best.model, kLastWord), kLastWord).model;
}

ShareDone part_of(const ShareDone& progress, double from, double to) {
  if (!progress) return {};
  return [progress, from, to](double share) { progress(from + share * (to - from)); };
}

Candidate judged(const std::vector<std::string>& kinds, const sim::DriveDescription& model, const RecordSet& training,
                 const RecordSet& validation) {
  return {kinds, model, error_over_own_floors(model, training), error_over_own_floors(model, validation)};
}

namespace {

/// The model with equal Stribeck speeds in both directions. An effect that disturbs the jogs biases each direction
/// separately, and a fit does not undo this. Empty if the speeds are already equal.
std::optional<sim::DriveDescription> with_even_fading(const sim::DriveDescription& model) {
  const sim::EffectEntry* stribeck = model.find("stribeck");
  const sim::EffectEntry* coulomb = model.find("coulomb");
  if (stribeck == nullptr || coulomb == nullptr || !stribeck->has("omega1_positive") || !coulomb->has("positive") ||
      !stribeck->has("static_positive"))
    return std::nullopt;
  sim::DriveDescription even = model;
  sim::EffectEntry& entry = *even.find("stribeck");
  for (const char* omega : {"omega1", "omega2"}) {
    const std::string positive = std::string(omega) + "_positive", negative = std::string(omega) + "_negative";
    const double mean = std::sqrt(std::abs(entry.at(positive) * entry.at(negative)));
    entry.parameters[positive] = mean;
    entry.parameters[negative] = -mean;
  }
  const double above = 0.5 * (entry.at("static_positive") / coulomb->at("positive") +
                              entry.at("static_negative") / coulomb->at("negative"));
  entry.parameters["static_positive"] = above * coulomb->at("positive");
  entry.parameters["static_negative"] = above * coulomb->at("negative");
  return even;
}

/// Refits the last effect from both sides of each of its parameters (unless they were scanned), because an effect at
/// breakaway or impact has several local minima. Also starts from the given base, because the refit without the effect
/// may have biased the base too far.
sim::DriveDescription shaken(const Start& finalist, const sim::DriveDescription* nominal, const RecordSet& set) {
  const sim::DriveDescription& model = finalist.model;
  std::vector<sim::DriveDescription> starts{model};
  if (nominal != nullptr) {
    starts.push_back(model);
    for (sim::EffectEntry& entry : starts.back().effects)
      if (const sim::EffectEntry* original = nominal->find(entry.kind)) entry = *original;
  }
  std::vector<std::string> ids;
  for (const auto& [id, value] : model.effects.back().parameters)
    if (!finalist.scanned && id != "period" && id != "cosine" && id != "sine") ids.push_back(id);
  const std::vector<sim::DriveDescription> bases = starts;
  const auto start_from = [&](const std::vector<std::string>& moved, double factor) {
    for (const sim::DriveDescription& base : bases) {
      starts.push_back(base);
      sim::EffectEntry& entry = starts.back().effects.back();
      for (const std::string& id : moved) {
        const sim::ParameterInfo& info = *sim::find_effect(entry.kind)->parameter(id);
        entry.parameters[id] = std::clamp(factor * entry.at(id), info.lower, info.upper);
      }
    }
  };
  for (const double factor : {0.55, 1.8}) {
    for (const std::string& id : ids) start_from({id}, factor);
    // Also changes all of them together, because a size and its time constant may be correlated.
    if (ids.size() > 1) start_from(ids, factor);
  }
  for (const sim::DriveDescription& base : bases)
    if (std::optional<sim::DriveDescription> even = with_even_fading(base)) starts.push_back(*std::move(even));
  const auto fitted = [&starts](const RecordSet& on, const FitOptions& options) {
    std::vector<FitResult> fits(starts.size());
    for_each_in_parallel(starts.size(), [&](std::size_t k) { fits[k] = fit_model(starts[k], on, options); });
    std::ranges::stable_sort(fits, {}, &FitResult::robust);
    return fits;
  };
  const RecordSet few = affordable(set, model, kTryout);
  if (starts.size() > kBestOfTryout) {
    // Successive halving (Jamieson and Talwalkar 2016): all starts get a few steps, the best of them more.
    const auto keep_best = [&](const std::vector<FitResult>& of, std::size_t most) {
      starts = {model};
      for (std::size_t k = 0; k < of.size() && starts.size() < most; ++k) starts.push_back(of[k].model);
    };
    FitOptions first = kTryout;
    first.most_iterations = kFirstSteps;
    keep_best(fitted(few, first), 2 * kBestOfTryout);
    keep_best(fitted(few, kTryout), kBestOfTryout);
  }
  return fitted(set, kSeriousFit).front().model;
}

bool is_confused_with(const sim::EffectInfo& one, const sim::EffectInfo& other) {
  return std::ranges::find(one.confused_with, other.kind) != one.confused_with.end();
}

/// Fits an effect, if it has no more parameters than the leader, on the leader's base: with its fitted and with its
/// original values, its size first. Its own fit may have ended in a local minimum of the base.
void try_on_base_of(const Start& leader, Start& rival, const sim::DriveDescription& base, const RecordSet& set,
                    const FitOptions& options) {
  if (rival.effect.parameters.size() > leader.effect.parameters.size()) return;
  double least = error_of(sim::Drive(rival.model), set).robust;
  for (const bool fitted : {true, false}) {
    Start again = rival;
    again.model = leader.model;
    again.model.effects.back() = fitted ? rival.model.effects.back() : rival.effect;
    if (!fitted) again.model = fit_model(again.model, set, kOwnSize).model;
    fit_start(again, base, set, 1.0, options);
    const double error = error_of(sim::Drive(again.model), set).robust;
    if (error >= least) continue;
    rival = again;
    least = error;
  }
}

/// A model that contains the base cannot be worse than the base. So if all fits of an effect are worse, it starts again
/// from the present base, and its size is fitted first, alone.
std::vector<Start> lost_starts(const std::vector<Start>& looked_at, const sim::DriveDescription& base) {
  std::vector<Start> lost;
  for (const Start& start : looked_at) {
    const auto is_promising = [&start](const Start& other) {
      return other.info == start.info && other.error <= kPromise;
    };
    if (start.scanned || start.info->periodic || needs_own_floors(start.model) ||
        std::ranges::any_of(looked_at, is_promising))
      continue;
    lost.push_back(start);
    lost.back().model = base;
    lost.back().model.effects.push_back(start.effect);
  }
  return lost;
}

/// Keeps the first of several starts that begin with the same values.
void drop_same(std::vector<Start>& starts) {
  std::vector<Start> kept;
  for (Start& start : starts)
    if (std::ranges::none_of(kept, [&](const Start& other) {
          const sim::EffectEntry &a = start.model.effects.back(), &b = other.model.effects.back();
          return a.kind == b.kind && a.parameters.size() == b.parameters.size() && !has_moved(a, b);
        }))
      kept.push_back(std::move(start));
  starts = std::move(kept);
}

/// The model of the force balance with `kinds` and this effect as the last one; empty if it did not try them. Its base
/// has not taken over the part of the effect, as one may that was fitted to the motion without it.
std::optional<sim::DriveDescription> balanced_start(const EffortScreen& balance, std::vector<std::string> kinds,
                                                    const sim::EffectInfo& info) {
  kinds.emplace_back(info.kind);
  for (const std::vector<ScreenedModel>& step : balance.steps)
    for (const ScreenedModel& tried : step) {
      if (!std::ranges::is_permutation(tried.kinds, kinds)) continue;
      sim::DriveDescription model = tried.model;
      const auto entry = std::ranges::find(model.effects, info.kind, &sim::EffectEntry::kind);
      std::rotate(entry, entry + 1, model.effects.end());
      return model;
    }
  return {};
}

}  // namespace

std::vector<Candidate> search_candidates(const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                                         const RecordSet& training, const RecordSet& validation,
                                         const ShareDone& progress, const SearchEffort& effort) {
  std::vector<const sim::EffectInfo*> infos;
  const auto is_among = [](const std::vector<std::string>& list, std::string_view kind) {
    return std::ranges::find(list, kind) != list.end();
  };
  for (const sim::EffectInfo* info : sim::catalogue())
    if (is_applicable(*info, model, training) && !is_among(kinds, info->kind) &&
        (effort.absent == nullptr || !is_among(*effort.absent, info->kind)))
      infos.push_back(info);
  return search_kinds(infos, model, kinds, training, validation, progress, effort);
}

std::vector<Candidate> search_kinds(const std::vector<const sim::EffectInfo*>& infos,
                                    const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                                    const RecordSet& training, const RecordSet& validation, const ShareDone& progress,
                                    const SearchEffort& effort) {
  const RecordSet coarse = thinned(training, effort.coarse_windows);
  const RecordSet medium = thinned(training, effort.medium_windows);
  const RecordSet last = thinned(training, effort.final_windows);
  const auto budgeted = [costly = needs_own_floors(model)](FitOptions options) {
    if (costly) options.most_steps *= kCostlyPart;
    return options;
  };
  std::vector<std::vector<Start>> starts_of(infos.size());
  for_each_in_parallel(infos.size(), [&](std::size_t k) {
    for (sim::DriveDescription& start : starting_models(*infos[k], model, training))
      if (training.measure != Measure::effort || has_inverse(sim::Drive(start)))
        starts_of[k].push_back({infos[k], std::move(start)});
    const bool is_scanned = !infos[k]->periodic && starts_of[k].size() > kMostStarts;
    // All friction on the load, and each other way to share it with the motor, is scanned separately, so that each
    // reaches the next stage.
    std::vector<std::vector<Start>> ways{std::move(starts_of[k])};
    if (const sim::ParameterInfo* friction = infos[k]->parameter("load_friction"))
      for (const double part : friction->starts) {
        ways.push_back(ways.front());
        for (Start& shared : ways.back()) {
          shared.model.effects.back().parameters[std::string(friction->id)] = part;
          shared.effect = shared.model.effects.back();
        }
      }
    starts_of[k].clear();
    for (std::vector<Start>& way : ways) {
      if (is_scanned && !way.empty()) scan(way, model, medium);
      std::ranges::move(way, std::back_inserter(starts_of[k]));
    }
  });
  std::vector<Start> starts;
  for (auto& list : starts_of) std::ranges::move(list, std::back_inserter(starts));
  if (effort.balance != nullptr)
    for (const sim::EffectInfo* info : infos)
      // Periods come from a spectrum over those that repeat within the travel, second masses from a scan.
      if (std::optional<sim::DriveDescription> start =
              info->periodic ? std::nullopt : balanced_start(*effort.balance, kinds, *info);
          start && !needs_own_floors(*start))
        starts.push_back({.info = info, .model = *std::move(start), .balanced = true});

  std::atomic<std::size_t> done{0};
  const double most = static_cast<double>(starts.size() + infos.size());
  const auto report = [&] {
    if (progress) progress(std::min(1.0, static_cast<double>(++done) / most));
  };
  const auto fit_all = [&](std::vector<Start>& list, const RecordSet& set, const FitOptions& options) {
    // The base is also fitted to these few windows, so that the comparison with the candidates is fair.
    const double base_error = fit_model(model, set, options).robust;
    for_each_in_parallel(list.size(), [&](std::size_t k) {
      // An effect that was found by a scan over many windows could not be found on a few.
      fit_start(list[k], model, list[k].scanned ? medium : set, base_error, options);
      report();
    });
    std::ranges::stable_sort(list, {}, &Start::error);
  };
  for_each_in_parallel(starts.size(), [&](std::size_t k) {
    if (starts[k].info->periodic) starts[k].model = fit_model(starts[k].model, coarse, kOwnSize).model;
  });
  fit_all(starts, coarse, budgeted(kFirstLook));
  std::vector<Start> lost = lost_starts(starts, model);
  for_each_in_parallel(lost.size(),
                       [&](std::size_t k) { lost[k].model = fit_model(lost[k].model, coarse, kOwnSize).model; });
  drop_same(lost);
  fit_all(lost, coarse, budgeted(kFirstLook));
  std::ranges::move(lost, std::back_inserter(starts));
  std::ranges::stable_sort(starts, {}, &Start::error);
  // A start that the force balance has fitted is ahead of those that a few passes could not fit yet.
  const auto unfitted = std::ranges::find(starts, false, &Start::balanced);
  const double in_sight = unfitted == starts.end() ? HUGE_VAL : kOutOfSight * unfitted->error;
  std::vector<Start> race;
  for (const Start& start : starts) {
    const bool far_behind = start.error > in_sight;
    const bool costly = needs_own_floors(start.model) && !needs_own_floors(model);
    if (start.error > kPromise || (far_behind && (costly || race.size() >= effort.finalists))) continue;
    const auto rivals = std::ranges::count(race, start.info, &Start::info);
    const auto leader = std::ranges::find(race, start.info, &Start::info);
    if (rivals == 0 || (rivals == 1 && start.error < kOpenRace * leader->error)) race.push_back(start);
  }
  fit_all(race, medium, budgeted(kSeriousFit));
  std::vector<Start> finalists;
  for (const Start& start : race)
    if (std::ranges::find(finalists, start.info, &Start::info) == finalists.end()) finalists.push_back(start);

  std::optional<Start> leader;
  if (!finalists.empty()) {
    const sim::DriveDescription& first = finalists.front().model;
    const RecordSet own = suited_to(first, affordable(medium, first, kSeriousFit));
    finalists.front().model = shaken(finalists.front(), effort.nominal, own);
    leader = finalists.front();
    // An effect that is often confused with the leader may have a larger error only because the base was biased.
    for (const Start& start : starts)
      if (is_confused_with(*leader->info, *start.info) && !needs_own_floors(start.model) &&
          std::ranges::find(finalists, start.info, &Start::info) == finalists.end())
        finalists.push_back(start);
  }
  const double within = leader ? kClose * leader->error : 0.0;
  const double leading = leader ? error_of(sim::Drive(leader->model), medium).robust : 0.0;
  std::vector<Candidate> candidates(finalists.size());
  for_each_in_parallel(finalists.size(), [&](std::size_t k) {
    bool is_close = k < effort.finalists && finalists[k].error < within;
    if (k > 0 && (is_close || is_confused_with(*leader->info, *finalists[k].info))) {
      try_on_base_of(*leader, finalists[k], model, medium, budgeted(kSeriousFit));
      is_close = is_close || error_of(sim::Drive(finalists[k].model), medium).robust < kClose * leading;
    }
    std::vector<std::string> all = kinds;
    all.emplace_back(finalists[k].info->kind);
    if (is_close) fit_start(finalists[k], model, last, 1.0, budgeted(kLastWord));
    candidates[k] = judged(all, finalists[k].model, training, validation);
  });
  std::ranges::stable_sort(candidates, {}, &Candidate::log_loss);
  if (effort.cut_short != nullptr)
    for (const std::vector<Start>* list : {&starts, &race, &finalists})
      for (const Start& start : *list)
        if (start.cut_short && std::ranges::find(*effort.cut_short, start.info->kind) == effort.cut_short->end())
          effort.cut_short->emplace_back(start.info->kind);
  return candidates;
}

}  // namespace host
