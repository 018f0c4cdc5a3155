#include "host/record/position_grid.hpp"

#include <algorithm>
#include <cmath>

#include "host/statistics.hpp"

namespace host {

double position_grid(const std::vector<double>& position) {
  constexpr double kOff = 0.02;  // of a step; allows for the digits of the text
  constexpr double kMostSteps = 200.0;
  // A single smallest change may be chance; a step occurs several times.
  constexpr std::size_t kFewestChanges = 50, kFewestSteps = 3;
  std::vector<double> moved;
  for (std::size_t k = 1; k < position.size(); ++k)
    if (const double change = std::abs(position[k] - position[k - 1]); change > 0.0 && std::isfinite(change))
      moved.push_back(change);
  if (moved.size() < kFewestChanges) return 0.0;
  const double step = *std::ranges::min_element(moved);
  std::size_t single = 0;
  for (double& change : moved) {
    change /= step;
    if (std::abs(change - std::round(change)) > kOff * std::max(1.0, std::sqrt(change))) return 0.0;
    if (change < 1.5) ++single;
  }
  return single >= kFewestSteps && median(std::move(moved)) <= kMostSteps ? step : 0.0;
}

}  // namespace host
