#include "host/search/effect_start.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "host/fit/fit_budget.hpp"
#include "host/parallel.hpp"
#include "host/search/pattern_search.hpp"

namespace host {

bool needs_own_floors(const sim::DriveDescription& model) {
  const sim::Drive drive(model);
  return drive.has_second_mass() || drive.bristles.has_value();
}

RecordSet suited_to(const sim::DriveDescription& model, const RecordSet& shared) {
  RecordSet own = shared;
  if (needs_own_floors(model)) renew_floors(own, model);
  return own;
}

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

namespace {

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

/// The starts of an effect for each way to share friction between motor and load.
std::vector<std::vector<Start>> ways_of(const std::vector<Start>& starts) {
  std::vector<std::vector<Start>> ways{starts};
  if (const sim::ParameterInfo* friction = starts.front().info->parameter("load_friction"))
    for (const double part : friction->starts) {
      ways.push_back(starts);
      for (Start& shared : ways.back()) {
        shared.model.effects.back().parameters[std::string(friction->id)] = part;
        shared.effect = shared.model.effects.back();
      }
    }
  return ways;
}

/// Evaluates the starts of each list, and fits the best of each by a search without gradients.
void scan(std::vector<std::vector<Start>>& lists, const sim::DriveDescription& base, const RecordSet& set) {
  const auto for_all = [&lists](const auto& work) {
    std::vector<Start*> all;
    for (std::vector<Start>& list : lists)
      for (Start& start : list) all.push_back(&start);
    for_each_in_parallel(all.size(), [&](std::size_t k) { work(*all[k]); });
  };
  for_all([&](Start& start) {
    start.error = left_at(start.model, base, set);
    start.scanned = true;
  });
  for (std::vector<Start>& starts : lists) {
    std::ranges::stable_sort(starts, {}, &Start::error);
    starts.resize(kBestOfScan, starts.front());
    std::erase_if(starts, [](const Start& start) { return start.error > kWorstOfScan; });
  }
  for_all([&](Start& start) {
    start.model = pattern_search(start.model, suited_to(start.model, affordable(set, start.model, kSeriousFit)),
                                 kSeriousFit.most_steps);
    start.error = left_at(start.model, base, set);
  });
}

}  // namespace

std::vector<Start> chosen_starts(const std::vector<std::vector<Start>>& effects, const sim::DriveDescription& base,
                                 const RecordSet& set) {
  std::vector<Start> chosen;
  std::vector<std::vector<Start>> to_scan;
  for (const std::vector<Start>& starts : effects) {
    const bool is_scanned = !starts.front().info->periodic && starts.size() > kMostStarts;
    for (std::vector<Start>& way : ways_of(starts)) {
      if (is_scanned)
        to_scan.push_back(std::move(way));
      else
        std::ranges::move(way, std::back_inserter(chosen));
    }
  }
  scan(to_scan, base, set);
  for (std::vector<Start>& way : to_scan) std::ranges::move(way, std::back_inserter(chosen));
  return chosen;
}

void fit_own_size(Start& start, const sim::DriveDescription& base, const RecordSet& shared, const FitOptions& budget) {
  const RecordSet own = suited_to(start.model, affordable(shared, start.model, budget));
  const FitResult fit = fit_model(start.model, own, kOwnSize);
  start.take(fit);
  start.error = fit.robust / error_of(sim::Drive(base), own).robust;
}

void keep_best(std::vector<Start>& starts) {
  constexpr std::ptrdiff_t kBest = 2;
  const auto way_of = [](const Start& start) {
    return start.effect.has("load_friction") ? start.effect.at("load_friction") : 1.0;
  };
  std::vector<Start> kept;
  for (Start& start : starts) {
    std::ptrdiff_t ahead = 0, ahead_by_this_way = 0;
    for (const Start& other : kept) {
      if (other.info != start.info || other.balanced) continue;
      ++ahead;
      if (way_of(other) == way_of(start)) ++ahead_by_this_way;
    }
    if (start.balanced || ahead < kBest || ahead_by_this_way == 0) kept.push_back(std::move(start));
  }
  starts = std::move(kept);
}

}  // namespace host
