#include "host/insight/candidate_search.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "host/insight/candidate_starts.hpp"
#include "host/insight/model_fit.hpp"
#include "host/insight/parallel.hpp"
#include "sim/catalogue.hpp"

namespace host {

namespace {

/// A candidate must lower the training error of a first look by this factor to be worth a serious fit.
constexpr double kPromise = 0.98;

/// Behind the best of a first look by this factor, only a few are worth a serious fit.
constexpr double kOutOfSight = 2.0;

/// Two starts of one effect are both pursued while their errors are so close.
constexpr double kOpenRace = 1.25;

constexpr FitOptions kFirstLook{.most_iterations = 8, .least_gain = 1e-3};
constexpr FitOptions kSeriousFit{.most_iterations = 15, .least_gain = 2e-4};
constexpr FitOptions kLastWord{.most_iterations = 12, .least_gain = 1e-5};

/// The set with about so many windows in use, evenly spread over the records.
RecordSet thinned(const RecordSet& set, std::size_t windows) {
  RecordSet thin = set;
  thin.stride = 1;
  thin.stride = std::max<std::size_t>(1, thin.used_windows() / windows);
  return thin;
}

struct Start {
  const sim::EffectInfo* info;
  sim::DriveDescription model;
  double error = HUGE_VAL;
};

}  // namespace

sim::DriveDescription fit_base(const sim::DriveDescription& given, const RecordSet& training) {
  // From the given values, and from a drive 25 % heavier or lighter with friction that goes the other way.
  std::vector<sim::DriveDescription> starts(3, given);
  const double factors[] = {1.0, 1.25, 0.8};
  for (std::size_t k = 1; k < starts.size(); ++k) {
    if (sim::EffectEntry* inertia = starts[k].find("inertia")) inertia->parameters["J"] *= factors[k];
    if (sim::EffectEntry* coulomb = starts[k].find("coulomb"))
      for (auto& [id, value] : coulomb->parameters) value /= factors[k];
  }
  const RecordSet thin = thinned(training, SearchEffort{}.medium_windows);
  std::vector<FitResult> results(starts.size());
  for_each_in_parallel(starts.size(), [&](std::size_t k) { results[k] = fit_model(starts[k], thin, kSeriousFit); });
  const FitResult& best = *std::ranges::min_element(results, {}, &FitResult::combined);
  return fit_model(best.model, training, kLastWord).model;
}

Candidate refine_candidate(const Candidate& candidate, const RecordSet& training, const RecordSet& validation) {
  const FitResult fit = fit_model(candidate.model, training, kLastWord);
  return {candidate.kinds, fit.model, fit.combined, error_of(sim::Drive(fit.model), validation)};
}

std::vector<Candidate> search_candidates(const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                                         const RecordSet& training, const RecordSet& validation,
                                         const Progress& progress, const SearchEffort& effort) {
  const RecordSet coarse = thinned(training, effort.coarse_windows);
  const RecordSet medium = thinned(training, effort.medium_windows);
  std::vector<const sim::EffectInfo*> infos;
  for (const sim::EffectInfo* info : sim::catalogue())
    if (is_applicable(*info, model, training)) infos.push_back(info);

  std::vector<std::vector<Start>> starts_of(infos.size());
  for_each_in_parallel(infos.size(), [&](std::size_t k) {
    for (sim::DriveDescription& start : starting_models(*infos[k], model, training))
      starts_of[k].push_back({infos[k], std::move(start)});
  });
  std::vector<Start> starts;
  for (auto& list : starts_of) std::ranges::move(list, std::back_inserter(starts));

  std::atomic<std::size_t> done{0};
  const double most = static_cast<double>(starts.size() + 2 * infos.size() + effort.finalists);
  const auto report = [&](std::size_t weight = 1) {
    done += weight;
    if (progress) progress(std::min(1.0, static_cast<double>(done) / most));
  };
  for_each_in_parallel(starts.size(), [&](std::size_t k) {
    const FitResult fit = fit_model(starts[k].model, coarse, kFirstLook);
    starts[k].model = fit.model;
    starts[k].error = fit.combined;
    report();
  });
  // The base gets the same chance to suit these few windows as the candidates had.
  const double base_error = fit_model(model, coarse, kFirstLook).combined;
  std::ranges::stable_sort(starts, {}, &Start::error);
  std::vector<Start> race;
  for (const Start& start : starts) {
    const bool far_behind = start.error > kOutOfSight * starts.front().error && race.size() >= effort.finalists;
    if (start.error > kPromise * base_error || far_behind) continue;
    const auto rivals = std::ranges::count(race, start.info, &Start::info);
    const auto leader = std::ranges::find(race, start.info, &Start::info);
    if (rivals == 0 || (rivals == 1 && start.error < kOpenRace * leader->error)) race.push_back(start);
  }
  for_each_in_parallel(race.size(), [&](std::size_t k) {
    const FitResult fit = fit_model(race[k].model, medium, kSeriousFit);
    race[k].model = fit.model;
    race[k].error = fit.combined;
    report();
  });
  std::ranges::stable_sort(race, {}, &Start::error);
  std::vector<Start> finalists;
  for (const Start& start : race)
    if (std::ranges::find(finalists, start.info, &Start::info) == finalists.end()) finalists.push_back(start);

  std::vector<Candidate> candidates(finalists.size());
  for_each_in_parallel(finalists.size(), [&](std::size_t k) {
    candidates[k].kinds = kinds;
    candidates[k].kinds.emplace_back(finalists[k].info->kind);
    candidates[k].model = finalists[k].model;
    candidates[k].train = finalists[k].error;
    if (k < effort.finalists) {
      candidates[k] = refine_candidate(candidates[k], training, validation);
    } else {
      candidates[k].validation = error_of(sim::Drive(candidates[k].model), validation);
    }
    report();
  });
  std::ranges::stable_sort(candidates, {}, [](const Candidate& candidate) { return candidate.validation.combined; });
  return candidates;
}

}  // namespace host
