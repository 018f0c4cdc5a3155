// A path as the host plans it and the board follows it: nodes with the motion of each axis.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace firmware {

/// Binary fractions of the words of a path's nodes: the host chooses the finest that hold its motion.
struct PathUnits {
  std::uint8_t travel_bits = 16;        ///< of a count
  std::uint8_t velocity_bits = 20;      ///< of a count a sample
  std::uint8_t acceleration_bits = 26;  ///< of a count a sample^2
};

constexpr bool is_possible(const PathUnits& units) {
  return units.travel_bits <= 24 && units.velocity_bits >= 17 && units.velocity_bits <= 30 &&
         units.acceleration_bits >= 17 && units.acceleration_bits <= 40;
}

/// Motion of one axis at the end of a piece of the path, which begins at the previous node.
struct PathAxisNode {
  std::int32_t travel = 0;        ///< since the node before, in units
  std::int32_t velocity = 0;      ///< here
  std::int32_t acceleration = 0;  ///< here
};

inline constexpr int kPathTimeBits = 12;  ///< of a sample, in durations
inline constexpr std::uint32_t kShortestPiece = 1u << kPathTimeBits;
inline constexpr std::uint32_t kLongestPiece = 1u << 22;  ///< 1,024 samples

/// The transmitted word of the duration, which also contains the headroom numbers.
inline constexpr int kHeadroomHereShift = 23, kHeadroomAheadShift = 27;

template <std::size_t axes>
struct PathNode {
  std::uint32_t duration : 23 = 0;  ///< of the piece that ends here, kShortestPiece to kLongestPiece
  /// Indices into kHeadrooms: of this piece and its neighbours, and the smallest of all pieces from its beginning until
  /// a changing clock could have slowed down to it: PathClock.
  std::uint32_t headroom_here : 4 = 0, headroom_ahead : 4 = 0;
  std::array<PathAxisNode, axes> axis{};

  constexpr void set_time(std::uint32_t word) {
    duration = word & ((1u << kHeadroomHereShift) - 1);
    headroom_here = word >> kHeadroomHereShift & 15u;
    headroom_ahead = word >> kHeadroomAheadShift & 15u;
  }
  constexpr bool is_at_rest() const {
    for (const PathAxisNode& one : axis)
      if (one.velocity != 0 || one.acceleration != 0) return false;
    return true;
  }
};

}  // namespace firmware
