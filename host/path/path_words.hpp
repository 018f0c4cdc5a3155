// Converts a planned path to a board's nodes: firmware/core/path/path_node.hpp.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/core/path/path_node.hpp"
#include "host/path/path_plan.hpp"

namespace host {

struct PathScale {
  std::vector<std::size_t> axes;  ///< the board's axis for each coordinate of the path; all different
  std::vector<double> count_mm;   ///< mm per count of each axis
  std::vector<double> unit_mm;    ///< unit of each axis's parameters: 1, or 1000 for metres
  double rate_Hz = 1000.0;
};

/// Present references of a board, where the path begins.
struct BoardPosition {
  std::int64_t counts = 0;
  double fraction = 0.0;  ///< fraction of a count
};

struct PathWord {
  std::uint32_t duration = 0;
  std::uint8_t headroom_here = 0, headroom_ahead = 0;  ///< indices in firmware::kHeadrooms
  std::vector<firmware::PathAxisNode> axis;            ///< in the order of PathScale::axes

  /// Word for firmware::PathNode::set_time().
  std::uint32_t time() const {
    return duration | std::uint32_t{headroom_here} << firmware::kHeadroomHereShift |
           std::uint32_t{headroom_ahead} << firmware::kHeadroomAheadShift;
  }
};

struct PathWords {
  firmware::PathUnits units;
  std::vector<PathWord> nodes;
};

/// The finest units in which the path fits the range of the nodes.
firmware::PathUnits units_of(const PlannedPath& path, const PathScale& scale);

/// Rounding errors do not accumulate: each node is within one unit of the plan. Throws Failure(bad_input) if the
/// beginning of the path differs from the board's reference by more than a count, or if the path is too fast for the
/// range of the nodes.
PathWords path_words(const PlannedPath& path, const PathScale& scale, const firmware::PathUnits& units,
                     const std::vector<BoardPosition>& start);

}  // namespace host
