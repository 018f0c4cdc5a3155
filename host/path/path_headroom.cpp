#include "host/path/path_headroom.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/core/path/path_clock.hpp"

namespace host {

namespace {

/// Longest time until a changing clock is constant again, s.
double longest_run_out_s(const AxisLimits& limits) {
  double change = std::numeric_limits<double>::infinity(), ramp = change;
  for (int i = 0; i < 3; ++i) {
    change =
        std::min(change, firmware::PathClock::change_limit(limits.velocity[i], limits.acceleration[i], limits.jerk[i]));
    ramp = std::min(ramp, firmware::PathClock::ramp_limit(limits.velocity[i], limits.jerk[i]));
  }
  return change / ramp;
}

}  // namespace

AxisLimits limits_at_rate(const AxisLimits& limits, double rate) {
  return {limits.velocity, limits.acceleration / (rate * rate), limits.jerk / (rate * rate * rate)};
}

void find_headroom(std::vector<PathKnot>& knots, const PathPlanOptions& options) {
  std::vector<double> own(knots.size(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 1; k < knots.size(); ++k) {
    const LimitUse use = limit_use(&knots[k - 1], &knots[k] + 1, options.limits);
    own[k] = 1.0 / std::max({std::sqrt(use.acceleration), std::cbrt(use.jerk), 1e-3});
  }
  // A third difference spans three samples, some of them partly.
  const double sample_s = options.time_unit_s * (1 << firmware::kPathTimeBits), near_s = 4.0 * sample_s;
  const double ahead_s = 1.1 * longest_run_out_s(options.limits) + 8.0 * sample_s;
  for (std::size_t k = 1; k < knots.size(); ++k) {
    double here = own[k];
    for (std::size_t i = k - 1; i > 0 && knots[i].time_s > knots[k - 1].time_s - near_s; --i)
      here = std::min(here, own[i]);
    double ahead = here;
    for (std::size_t i = k + 1; i < knots.size() && knots[i - 1].time_s < knots[k].time_s + ahead_s; ++i) {
      if (knots[i - 1].time_s < knots[k].time_s + near_s) here = std::min(here, own[i]);
      ahead = std::min(ahead, own[i]);
    }
    knots[k].headroom_here = here;
    knots[k].headroom_ahead = std::min(here, ahead);
  }
}

}  // namespace host
