// The motion between two nodes of a path: for each axis the polynomial of fifth degree in time that has position,
// velocity and acceleration of both (quintic Hermite interpolation).
#pragma once

#include <bit>
#include <optional>

#include "firmware/core/arithmetic/count_position.hpp"
#include "firmware/core/arithmetic/hide_origin.hpp"
#include "firmware/core/path/path_node.hpp"

namespace firmware {

namespace path_piece {

/// Counts with 28 binary places; positions within a piece.
inline constexpr int kBits = 28;
/// 2^24 counts: coefficients for the powers of half the share, and their sums, then fit 64 bits (below 2^62).
inline constexpr std::int64_t kMost = std::int64_t{1} << (24 + kBits);

/// value * factor * 2^-shift, downwards, 0 < shift <= 32; the result fits.
constexpr std::int64_t scaled(std::int64_t value, std::uint32_t factor, int shift) {
  const auto low = static_cast<std::uint32_t>(value);
  const std::int64_t high = value >> 32;
  const std::uint64_t of_low = std::uint64_t{low} * factor;
  return ((high * factor) << (32 - shift)) + static_cast<std::int64_t>(of_low >> shift);
}

/// value * share / 2^32, downwards; `share` in 2^-31, below 1. Two long multiplications; four if the compiler sees that
/// either factor has 64 bits.
constexpr std::int64_t half_of_share(std::int64_t value, std::uint32_t share) {
  auto upper = static_cast<std::int32_t>(value >> 32);
  hide_origin(upper);
  const std::uint64_t lower = std::uint64_t{static_cast<std::uint32_t>(value)} * share;
  return std::int64_t{upper} * static_cast<std::int32_t>(share) + static_cast<std::uint32_t>(lower >> 32);
}

/// The same for values >= 0, 0 <= shift <= 32.
constexpr std::int64_t part_of(std::int64_t value, std::uint32_t factor, int shift) {
  const std::uint64_t high = std::uint64_t{static_cast<std::uint32_t>(value >> 32)} * factor;
  const std::uint64_t low = std::uint64_t{static_cast<std::uint32_t>(value)} * factor;
  return static_cast<std::int64_t>((high << (32 - shift)) + (low >> shift));
}

constexpr std::int64_t shifted(std::int64_t value, int left) { return left >= 0 ? value << left : value >> -left; }

constexpr bool fits(std::int64_t value) { return value >= -kMost && value <= kMost; }

/// Velocity and acceleration as position terms: V = v T, A = a T^2, with the duration T.
struct Ends {
  std::int64_t travel = 0, begin_velocity = 0, end_velocity = 0, begin_acceleration = 0, end_acceleration = 0;
};

constexpr std::int64_t way_of_velocity(std::int32_t velocity, int bits, std::uint32_t duration) {
  return shifted(velocity * std::int64_t{duration}, kBits - bits - kPathTimeBits);  // below 2^60
}

/// Above kMost if it does not fit.
constexpr std::int64_t way_of_acceleration(std::int32_t acceleration, int bits, std::uint32_t duration) {
  const std::int64_t velocity = shifted(acceleration * std::int64_t{duration}, kBits - bits - kPathTimeBits);
  constexpr std::int64_t kFastest = std::int64_t{1} << (14 + kBits);  // as motion limits require
  if (velocity > kFastest || velocity < -kFastest) return kMost + 1;
  return scaled(velocity, duration, kPathTimeBits);
}

}  // namespace path_piece

/// Whole numbers throughout: the same on every machine.
template <std::size_t axes>
class PathPiece {
 public:
  /// Empty if a word is too large for the duration.
  static constexpr std::optional<PathPiece> between(const std::array<PathAxisNode, axes>& begin,
                                                    const PathNode<axes>& end, const PathUnits& units) {
    using namespace path_piece;
    PathPiece piece;
    piece.headroom_here_ = static_cast<std::uint8_t>(end.headroom_here);
    piece.headroom_ahead_ = static_cast<std::uint8_t>(end.headroom_ahead);
    const std::uint32_t duration = end.duration;
    piece.duration_ = static_cast<Increment>(duration) << (kFractionBits - kPathTimeBits);
    const int length = 32 - std::countl_zero(duration);
    piece.shift_ = static_cast<std::uint8_t>(kFractionBits - kPathTimeBits - 32 + length);
    piece.reciprocal_ = static_cast<std::uint32_t>(((std::uint64_t{1} << 63) - 1) / (duration << (32 - length)));
    for (std::size_t i = 0; i < axes; ++i) {
      const Ends e{std::int64_t{end.axis[i].travel} << (kBits - units.travel_bits),
                   way_of_velocity(begin[i].velocity, units.velocity_bits, duration),
                   way_of_velocity(end.axis[i].velocity, units.velocity_bits, duration),
                   way_of_acceleration(begin[i].acceleration, units.acceleration_bits, duration),
                   way_of_acceleration(end.axis[i].acceleration, units.acceleration_bits, duration)};
      for (const std::int64_t way :
           {e.travel, e.begin_velocity, e.end_velocity, e.begin_acceleration, e.end_acceleration})
        if (!fits(way)) return {};
      Polynomial& p = piece.axis_[i];
      p.travel = e.travel;
      p.term[0] = e.begin_velocity;
      p.term[1] = e.begin_acceleration >> 1;
      p.term[2] = 10 * e.travel - 6 * e.begin_velocity - 4 * e.end_velocity -
                  ((3 * e.begin_acceleration - e.end_acceleration) >> 1);
      p.term[3] = -15 * e.travel + 8 * e.begin_velocity + 7 * e.end_velocity +
                  ((3 * e.begin_acceleration - 2 * e.end_acceleration) >> 1);
      p.term[4] =
          6 * e.travel - 3 * (e.begin_velocity + e.end_velocity) - ((e.begin_acceleration - e.end_acceleration) >> 1);
      for (std::size_t power = 0; power < p.term.size(); ++power) p.term[power] <<= power + 1;
    }
    return piece;
  }

  /// Index into kHeadrooms.
  constexpr std::uint32_t headroom_here() const { return headroom_here_; }
  constexpr std::uint32_t headroom_ahead() const { return headroom_ahead_; }

  /// Unit: kOneCount per sample.
  constexpr Increment duration() const { return duration_; }

  /// The share of the duration that has passed, in 2^-31. 0 <= time < duration().
  constexpr std::uint32_t share(Increment time) const {
    // As two words: shift_ lies in 17..31.
    const auto bits = static_cast<std::uint64_t>(time);
    const std::uint32_t scaled = static_cast<std::uint32_t>(bits) >> shift_ | static_cast<std::uint32_t>(bits >> 32)
                                                                                  << (32 - shift_);
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(scaled) * reciprocal_) >> 32);
  }

  /// Travel of an axis since the beginning of the piece, 2^-kBits counts.
  constexpr std::int64_t travel_at(std::size_t axis, std::uint32_t share) const {
    const Polynomial& p = axis_[axis];
    hide_origin(share);
    std::int64_t sum = p.term[4];
    for (int i = 3; i >= 0; --i) sum = p.term[static_cast<std::size_t>(i)] + path_piece::half_of_share(sum, share);
    return path_piece::half_of_share(sum, share);
  }
  /// Coefficients of the powers 1 to 5 of the share of the duration, counts.
  constexpr std::array<float, 5> coefficients(std::size_t axis) const {
    std::array<float, 5> all{};
    for (std::size_t power = 0; power < all.size(); ++power)
      all[power] = ScalarTraits<float>::from_increment(axis_[axis].term[power] >> (power + 1)) *
                   (std::int64_t{1} << (kFractionBits - path_piece::kBits));
    return all;
  }

  constexpr std::int64_t whole_travel(std::size_t axis) const { return axis_[axis].travel; }

 private:
  struct Polynomial {
    std::array<std::int64_t, 5> term{};  ///< of the powers 1 to 5 of half the share
    std::int64_t travel = 0;
  };
  Increment duration_ = 0;
  std::uint8_t headroom_here_ = 0, headroom_ahead_ = 0;
  std::uint8_t shift_ = 0;        ///< scales a time to 32 bits; the highest bit of the scaled duration is set
  std::uint32_t reciprocal_ = 0;  ///< 2^63 / the scaled duration
  std::array<Polynomial, axes> axis_{};
};

}  // namespace firmware
