#include "host/path/path_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/core/path/path_headroom.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

constexpr double kMostWord = 2147483000.0;

std::uint8_t bits_for(double largest, int least, int most) {
  int bits = most;
  while (bits > least && std::ldexp(largest, bits) > kMostWord) --bits;
  if (std::ldexp(largest, bits) > kMostWord)
    throw Failure(ExitCode::bad_input, "the path is too fast for its encoder: lower the feed");
  return static_cast<std::uint8_t>(bits);
}

std::int32_t word(double value, int bits) { return static_cast<std::int32_t>(std::llround(std::ldexp(value, bits))); }

}  // namespace

firmware::PathUnits units_of(const PlannedPath& path, const PathScale& scale) {
  double travel = 0.0, velocity = 0.0, acceleration = 0.0;
  for (std::size_t k = 0; k < path.knots.size(); ++k) {
    for (std::size_t i = 0; i < scale.axes.size(); ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const double counts = 1.0 / scale.count_mm[i];
      if (k > 0)
        travel = std::max(travel, std::abs(path.knots[k].position[axis] - path.knots[k - 1].position[axis]) * counts);
      velocity = std::max(velocity, std::abs(path.knots[k].velocity[axis]) * counts / scale.rate_Hz);
      acceleration =
          std::max(acceleration, std::abs(path.knots[k].acceleration[axis]) * counts / (scale.rate_Hz * scale.rate_Hz));
    }
  }
  return {bits_for(travel + 1.0, 8, 24), bits_for(velocity, 17, 30), bits_for(acceleration, 17, 40)};
}

PathWords path_words(const PlannedPath& path, const PathScale& scale, const firmware::PathUnits& units,
                     const std::vector<BoardPosition>& start) {
  PathWords words{units, {}};
  const std::size_t axes = scale.axes.size();
  std::vector<std::int64_t> base(axes), at(axes);  // base in whole counts; at in units from there
  const double grid = std::ldexp(1.0, units.travel_bits);
  for (std::size_t i = 0; i < axes; ++i) {
    base[i] = start[i].counts;
    at[i] = static_cast<std::int64_t>(std::floor(start[i].fraction * grid));
    const double begins = path.knots.front().position[static_cast<Eigen::Index>(i)] / scale.count_mm[i];
    if (std::abs(begins - static_cast<double>(base[i]) - start[i].fraction) > 1.0)
      throw Failure(ExitCode::bad_input, "the path does not begin where the axes stand");
  }
  std::int64_t time = 0;  // in node units, so that rounding errors do not accumulate
  constexpr double kTimeUnits = 1u << firmware::kPathTimeBits;
  for (std::size_t k = 1; k < path.knots.size(); ++k) {
    const PathKnot& knot = path.knots[k];
    const std::int64_t there = std::llround(knot.time_s * scale.rate_Hz * kTimeUnits);
    PathWord node;
    node.duration = static_cast<std::uint32_t>(there - time);
    node.headroom_here = firmware::headroom_number(knot.headroom_here);
    node.headroom_ahead = firmware::headroom_number(knot.headroom_ahead);
    time = there;
    for (std::size_t i = 0; i < axes; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const double counts = knot.position[axis] / scale.count_mm[i];
      const double whole = std::floor(counts);
      const std::int64_t units_there = (static_cast<std::int64_t>(whole) - base[i]) * static_cast<std::int64_t>(grid) +
                                       std::llround((counts - whole) * grid);
      node.axis.push_back({static_cast<std::int32_t>(units_there - at[i]),
                           word(knot.velocity[axis] / scale.count_mm[i] / scale.rate_Hz, units.velocity_bits),
                           word(knot.acceleration[axis] / scale.count_mm[i] / (scale.rate_Hz * scale.rate_Hz),
                                units.acceleration_bits)});
      at[i] = units_there;
    }
    words.nodes.push_back(std::move(node));
  }
  return words;
}

}  // namespace host
