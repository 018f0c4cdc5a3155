#include "host/fit/fit_budget.hpp"

#include <algorithm>
#include <cmath>

namespace host {

WindowCounts WindowCounts::over(double window_s) const {
  const auto scaled = [&](std::size_t windows) {
    return static_cast<std::size_t>(static_cast<double>(windows) * kWindow_s / window_s);
  };
  return {.coarse = scaled(coarse), .medium = scaled(medium), .final = scaled(final)};
}

RecordSet thinned(const RecordSet& set, std::size_t windows) {
  RecordSet thin = set;
  thin.stride = 1;
  thin.stride = std::max<std::size_t>(1, thin.used_windows() / windows);
  return thin;
}

RecordSet affordable(const RecordSet& set, const sim::DriveDescription& model, const FitOptions& options) {
  constexpr std::size_t kLeastWindows = 10;
  constexpr double kLeastPasses = 50.0;  // for a useful fit: six Jacobians of some eight parameters
  const double share = kLeastPasses * steps_of(sim::Drive(model), set) / options.most_steps;
  RecordSet thin = set;
  if (share > 1.0)
    thin.stride = std::clamp(static_cast<std::size_t>(std::ceil(share * static_cast<double>(set.stride))), set.stride,
                             std::max(set.stride, set.stride * set.used_windows() / kLeastWindows));
  return thin;
}

}  // namespace host
