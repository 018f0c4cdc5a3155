// A planned path in the words that a board takes: firmware/core/path/path_node.hpp.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/core/path/path_node.hpp"
#include "host/path/path_plan.hpp"

namespace host {

struct PathScale {
  std::vector<std::size_t> axes;  ///< of the board, for each coordinate of the path; all different
  std::vector<double> count_mm;   ///< of each of them
  std::vector<double> unit_mm;    ///< unit of each axis's parameters: 1, or 1000 for metres
  double rate_Hz = 1000.0;
};

/// Where a board's references stand: the path begins there.
struct BoardPosition {
  std::int64_t counts = 0;
  double fraction = 0.0;  ///< of a count
};

struct PathWord {
  std::uint32_t duration = 0;
  std::uint8_t headroom_here = 0, headroom_ahead = 0;  ///< numbers of firmware::kHeadrooms
  std::vector<firmware::PathAxisNode> axis;            ///< in the order of PathScale::axes

  /// As firmware::PathNode::set_time() takes it.
  std::uint32_t time() const {
    return duration | std::uint32_t{headroom_here} << firmware::kHeadroomHereShift |
           std::uint32_t{headroom_ahead} << firmware::kHeadroomAheadShift;
  }
};

struct PathWords {
  firmware::PathUnits units;
  std::vector<PathWord> nodes;
};

/// In the finest units that hold the path.
firmware::PathUnits units_of(const PlannedPath& path, const PathScale& scale);

/// Errors of rounding do not add up: each node lies where the plan has it, to within its unit. Throws
/// Failure(bad_input) where the path begins elsewhere than the board stands, by more than a count, or is faster than
/// words can say.
PathWords path_words(const PlannedPath& path, const PathScale& scale, const firmware::PathUnits& units,
                     const std::vector<BoardPosition>& start);

}  // namespace host
