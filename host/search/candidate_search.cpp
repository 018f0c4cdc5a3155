#include "host/search/candidate_search.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "host/fit/fit_budget.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/parallel.hpp"
#include "host/search/balance_odds.hpp"
#include "host/search/candidate_starts.hpp"
#include "host/search/effect_start.hpp"
#include "host/search/explained_share.hpp"
#include "host/search/physical_range.hpp"
#include "sim/catalogue.hpp"
#include "sim/second_mass.hpp"

namespace host {

Candidate judged(const std::vector<std::string>& kinds, const sim::DriveDescription& model, const RecordSet& training,
                 const RecordSet& validation) {
  return {kinds, model, error_over_own_floors(model, training), error_over_own_floors(model, validation)};
}

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

/// Budget for each start near a finalist: enough to find the deepest local minimum.
constexpr FitOptions kTryout{.most_iterations = 7, .least_gain = 1e-3, .most_steps = 2.5e6};
constexpr std::size_t kBestOfTryout = 4;
constexpr int kFirstSteps = 3;  // of each start, before the better ones are fitted further
/// If the base itself needs many small steps, so does every candidate. Each candidate then gets this share of its
/// budget.
constexpr double kCostlyPart = 0.4;

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

/// The model with those effects as given that the given model has.
sim::DriveDescription on_given_base(sim::DriveDescription model, const sim::DriveDescription& given) {
  for (sim::EffectEntry& entry : model.effects)
    if (const sim::EffectEntry* original = given.find(entry.kind)) entry = *original;
  return model;
}

/// Refits the last effect from both sides of each of its parameters (unless they were scanned), because an effect at
/// breakaway or impact has several local minima. Also starts from the given base, because the refit without the effect
/// may have biased the base too far.
sim::DriveDescription shaken(const Start& finalist, const sim::DriveDescription* nominal, const RecordSet& set) {
  const sim::DriveDescription& model = finalist.model;
  std::vector<sim::DriveDescription> starts{model};
  if (nominal != nullptr) starts.push_back(on_given_base(model, *nominal));
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
/// original values. Its own fit may have ended in a local minimum of the base. Its size is fitted first, alone; if the
/// error is then far above the leader's, `leading`, the rest is not fitted.
void try_on_base_of(const Start& leader, Start& rival, const sim::DriveDescription& base, const RecordSet& set,
                    const FitOptions& options, double leading) {
  if (rival.effect.parameters.size() > leader.effect.parameters.size()) return;
  double least = error_of(sim::Drive(rival.model), set).robust;
  for (const bool fitted : {true, false}) {
    Start again = rival;
    again.model = leader.model;
    again.model.effects.back() = fitted ? rival.model.effects.back() : rival.effect;
    again.model = fit_model(again.model, set, kOwnSize).model;
    if (error_of(sim::Drive(again.model), set).robust > kOutOfSight * leading) continue;
    fit_start(again, base, set, 1.0, options);
    const double error = error_of(sim::Drive(again.model), set).robust;
    if (error >= least) continue;
    rival = again;
    least = error;
  }
}

/// The search over several effects on one base.
class KindSearch {
 public:
  /// Keeps references. `drops`: leaves out effects that the force balance or a leader that explains the records rules
  /// out.
  KindSearch(const sim::DriveDescription& model, const std::vector<std::string>& kinds, const RecordSet& training,
             const RecordSet& validation, const SearchEffort& effort, bool drops)
      : model_(model),
        kinds_(kinds),
        training_(training),
        validation_(validation),
        effort_(effort),
        coarse_(thinned(training, effort.windows.coarse)),
        medium_(thinned(training, effort.windows.medium)),
        last_(thinned(training, effort.windows.final)),
        drops_(drops),
        is_costly_(needs_own_floors(model)),
        // The base is also fitted to these few windows, so that the comparison with the candidates is fair.
        coarse_error_(fit_model(model, coarse_, budgeted(kFirstLook)).robust),
        medium_error_(fit_model(model, medium_, budgeted(kSeriousFit)).robust) {}

  std::vector<Candidate> run(std::vector<const sim::EffectInfo*> infos, const ShareDone& progress) {
    if (drops_) look_at_probable(infos);
    const sim::EffectInfo* leader = explaining_effect();
    std::erase_if(infos, [&](const sim::EffectInfo* info) { return is_ruled_out_by(leader, *info); });
    // Effects that need many small steps, although the base does not, follow when the others have been fitted.
    std::vector<std::vector<Start>> first, later;
    for (std::vector<Start>& starts : starts_of(infos))
      (is_costly_ || !needs_own_floors(starts.front().model) ? first : later).push_back(std::move(starts));
    look_at(first, part_of(progress, 0.0, 0.4));
    leader = explaining_effect();
    const bool has_load = !drops_ || effort_.balance == nullptr || allows_second_mass(*effort_.balance, kinds_);
    std::erase_if(later, [&](const std::vector<Start>& starts) {
      const Start& start = starts.front();
      return is_ruled_out_by(leader, *start.info) || (!has_load && sim::is_second_mass(start.info->kind));
    });
    look_at(later, part_of(progress, 0.4, 0.7));
    std::vector<Candidate> candidates = candidates_of(finalists());
    if (progress) progress(1.0);
    return candidates;
  }

 private:
  FitOptions budgeted(FitOptions options) const {
    if (is_costly_) options.most_steps *= kCostlyPart;
    return options;
  }

  /// Fits those effects of which the force balance holds one to be present, from where it has fitted them.
  void look_at_probable(const std::vector<const sim::EffectInfo*>& infos) {
    if (effort_.balance == nullptr) return;
    const std::vector<std::string> probable = probable_kinds(*effort_.balance, kinds_);
    std::vector<Start> starts;
    for (const sim::EffectInfo* info : infos) {
      if (std::ranges::find(probable, info->kind) == probable.end()) continue;
      if (std::optional<sim::DriveDescription> start = balanced_start(*effort_.balance, kinds_, *info))
        starts.push_back({.info = info, .model = *std::move(start), .balanced = true});
    }
    fit_all(starts, medium_, budgeted(kSeriousFit), medium_error_, {});
    std::ranges::move(starts, std::back_inserter(race_));
  }

  /// The leader, if it explains the records and may rule out others; or nullptr.
  const sim::EffectInfo* explaining_effect() const {
    return drops_ && !race_.empty() && explains(race_.front()) ? race_.front().info : nullptr;
  }

  /// Beside a leader that explains the records, only those effects are of interest that may be confused with it and
  /// that the force balance does not tell from it.
  bool is_ruled_out_by(const sim::EffectInfo* leader, const sim::EffectInfo& other) const {
    if (leader == nullptr) return false;
    return &other == leader || (!is_confused_with(*leader, other) && !is_confused_with(other, *leader)) ||
           (effort_.balance != nullptr && are_told_apart(*effort_.balance, kinds_, leader->kind, other.kind));
  }

  /// The starts of each effect; effects without a start are left out.
  std::vector<std::vector<Start>> starts_of(const std::vector<const sim::EffectInfo*>& infos) const {
    std::vector<std::vector<Start>> starts(infos.size());
    for_each_in_parallel(infos.size(), [&](std::size_t k) {
      std::vector<sim::DriveDescription> models = starting_models(*infos[k], model_, training_);
      // A wave of slow motion biases the base so far that it is not found beside it.
      if (infos[k]->periodic && effort_.nominal != nullptr)
        std::ranges::move(starting_models(*infos[k], on_given_base(model_, *effort_.nominal), training_),
                          std::back_inserter(models));
      for (sim::DriveDescription& start : models)
        if (training_.measure != Measure::effort || has_inverse(sim::Drive(start)))
          starts[k].push_back({infos[k], std::move(start)});
    });
    std::erase_if(starts, [](const std::vector<Start>& list) { return list.empty(); });
    return starts;
  }

  bool explains(const Start& start) const {
    std::vector<std::string> kinds = kinds_;
    kinds.emplace_back(start.info->kind);
    return error_over_own_floors(start.model, medium_).combined <= kExplained &&
           unphysical_parameters(start.model, kinds, training_).empty();
  }

  void fit_all(std::vector<Start>& list, const RecordSet& set, const FitOptions& options, double base_error,
               const ShareDone& progress) const {
    std::atomic<std::size_t> done{0};
    for_each_in_parallel(list.size(), [&](std::size_t k) {
      // An effect that was found by a scan over many windows could not be found on a few.
      fit_start(list[k], model_, list[k].scanned ? medium_ : set, base_error, options);
      if (progress) progress(static_cast<double>(++done) / static_cast<double>(list.size()));
    });
    std::ranges::stable_sort(list, {}, &Start::error);
  }

  /// Takes a first look at each start of these effects, and fits the most promising ones.
  void look_at(const std::vector<std::vector<Start>>& effects, const ShareDone& progress) {
    std::vector<Start> starts = chosen_starts(effects, model_, medium_);
    for (const std::vector<Start>& of_one : effects) {
      const sim::EffectInfo& info = *of_one.front().info;
      if (effort_.balance == nullptr) continue;
      // Second masses come from a scan.
      if (std::optional<sim::DriveDescription> start = balanced_start(*effort_.balance, kinds_, info);
          start && !needs_own_floors(*start))
        starts.push_back({.info = &info, .model = *std::move(start), .balanced = true});
    }
    // The base was fitted without the effect and would suppress it. So its size is fitted first, alone.
    for_each_in_parallel(starts.size(), [&](std::size_t k) {
      if (!starts[k].scanned && !starts[k].balanced) fit_own_size(starts[k], model_, coarse_, budgeted(kFirstLook));
    });
    std::ranges::stable_sort(starts, {}, &Start::error);
    keep_best(starts);
    // Successive halving (Jamieson and Talwalkar 2016): all starts get a few steps, the best of them more.
    FitOptions few_steps = budgeted(kFirstLook);
    few_steps.most_iterations = kFirstSteps;
    fit_all(starts, coarse_, few_steps, coarse_error_, progress);
    const auto behind = starts.begin() + static_cast<std::ptrdiff_t>(std::min(2 * effort_.finalists, starts.size()));
    std::vector<Start> others(std::make_move_iterator(behind), std::make_move_iterator(starts.end()));
    starts.erase(behind, starts.end());
    fit_all(starts, coarse_, budgeted(kFirstLook), coarse_error_, progress);
    std::ranges::move(others, std::back_inserter(starts));
    std::ranges::stable_sort(starts, {}, &Start::error);
    std::vector<Start> entrants = promising(starts);
    fit_all(entrants, medium_, budgeted(kSeriousFit), medium_error_, {});
    std::ranges::move(starts, std::back_inserter(starts_));
    std::ranges::move(entrants, std::back_inserter(race_));
    std::ranges::stable_sort(starts_, {}, &Start::error);
    std::ranges::stable_sort(race_, {}, &Start::error);
  }

  /// The starts that get a serious fit. `starts`: in the order of their errors.
  std::vector<Start> promising(const std::vector<Start>& starts) {
    // A start that the force balance has fitted is ahead of those that a few passes could not fit yet.
    if (const auto unfitted = std::ranges::find(starts, false, &Start::balanced); unfitted != starts.end())
      in_sight_ = std::min(in_sight_, kOutOfSight * unfitted->error);
    std::vector<Start> chosen;
    for (const Start& start : starts) {
      const bool far_behind = start.error > in_sight_;
      const bool costly = needs_own_floors(start.model) && !is_costly_;
      if (start.error > kPromise || (far_behind && (costly || race_.size() + chosen.size() >= effort_.finalists)))
        continue;
      const auto rivals = std::ranges::count(chosen, start.info, &Start::info);
      const auto leader = std::ranges::find(chosen, start.info, &Start::info);
      if (rivals == 0 || (rivals == 1 && start.error < kOpenRace * leader->error)) chosen.push_back(start);
    }
    return chosen;
  }

  /// The best start of each effect, and the effects that are often confused with the leader.
  std::vector<Start> finalists() const {
    std::vector<Start> list;
    const auto is_new = [&](const Start& start) {
      return std::ranges::find(list, start.info, &Start::info) == list.end();
    };
    for (const Start& start : race_)
      if (is_new(start)) list.push_back(start);
    if (list.empty()) return list;
    Start& leader = list.front();
    // A fit that leaves no more than the noise floor has found no poor local minimum. Given effects may change nothing
    // there, and are still to be fitted as well as possible.
    if (!drops_ || error_over_own_floors(leader.model, medium_).combined > 1.0)
      leader.model =
          shaken(leader, effort_.nominal, suited_to(leader.model, affordable(medium_, leader.model, kSeriousFit)));
    // Such an effect may have a larger error only because the base was biased.
    const sim::EffectInfo& first = *leader.info;
    for (const Start& start : starts_)
      if (is_confused_with(first, *start.info) && !needs_own_floors(start.model) && is_new(start))
        list.push_back(start);
    return list;
  }

  std::vector<Candidate> candidates_of(std::vector<Start> finalists) const {
    std::vector<Candidate> candidates(finalists.size());
    if (finalists.empty()) return candidates;
    const Start leader = finalists.front();
    const double leading = error_of(sim::Drive(leader.model), medium_).robust;
    for_each_in_parallel(finalists.size(), [&](std::size_t k) {
      Start& one = finalists[k];
      bool is_close = k < effort_.finalists && one.error < kClose * leader.error;
      if (k > 0 && (is_close || is_confused_with(*leader.info, *one.info))) {
        try_on_base_of(leader, one, model_, medium_, budgeted(kSeriousFit), leading);
        is_close = is_close || error_of(sim::Drive(one.model), medium_).robust < kClose * leading;
      }
      if (is_close) fit_start(one, model_, last_, 1.0, budgeted(kLastWord));
      std::vector<std::string> all = kinds_;
      all.emplace_back(one.info->kind);
      candidates[k] = judged(all, one.model, training_, validation_);
    });
    std::ranges::stable_sort(candidates, {}, &Candidate::log_loss);
    if (effort_.cut_short != nullptr) note_cut_short(finalists, *effort_.cut_short);
    return candidates;
  }

  void note_cut_short(const std::vector<Start>& finalists, std::vector<std::string>& kinds) const {
    for (const std::vector<Start>* list : {&starts_, &race_, &finalists})
      for (const Start& start : *list)
        if (start.cut_short && std::ranges::find(kinds, start.info->kind) == kinds.end())
          kinds.emplace_back(start.info->kind);
  }

  const sim::DriveDescription& model_;
  const std::vector<std::string>& kinds_;
  const RecordSet &training_, &validation_;
  const SearchEffort& effort_;
  RecordSet coarse_, medium_, last_;
  bool drops_;
  bool is_costly_;  ///< the base itself needs many small steps
  double coarse_error_, medium_error_;
  std::vector<Start> starts_, race_;  ///< after the first look, and after the serious fits; best first
  double in_sight_ = HUGE_VAL;        ///< largest error after the first look that is not far behind
};

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
  return KindSearch(model, kinds, training, validation, effort, true).run(std::move(infos), progress);
}

std::vector<Candidate> search_kinds(const std::vector<const sim::EffectInfo*>& infos,
                                    const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                                    const RecordSet& training, const RecordSet& validation, const ShareDone& progress,
                                    const SearchEffort& effort) {
  return KindSearch(model, kinds, training, validation, effort, false).run(infos, progress);
}

}  // namespace host
