#include "host/fit/base_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "host/fit/fit_budget.hpp"
#include "host/parallel.hpp"

namespace host {

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
  const WindowCounts windows = WindowCounts{}.over(window_s);
  const RecordSet thin = thinned(training, windows.medium);
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
  const RecordSet last = thinned(training, windows.final);
  return fit_model(best.model, affordable(last, best.model, kLastWord), kLastWord).model;
}

}  // namespace host
