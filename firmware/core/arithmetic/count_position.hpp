// A position that never loses resolution: whole encoder counts and a binary fraction of one.
#pragma once

#include <cstdint>
#include <limits>

#include "firmware/core/arithmetic/scalar.hpp"

namespace firmware {

/// Travel in one sample, in units of 2^-48 encoder counts. As speed it reaches 2^15 counts a sample (80 m/s at 1 kHz
/// and 2.44 um), and resolves a drift of one count in 9000 years at 1 kHz.
using Increment = std::int64_t;

inline constexpr Increment kOneCount = Increment{1} << kFractionBits;

/// Position = counts + fraction * 2^-48, with 0 <= fraction < 2^48. Sums are exact.
struct CountPosition {
  std::int64_t counts = 0;
  std::int64_t fraction = 0;

  static constexpr CountPosition at(std::int64_t whole_counts) { return {whole_counts, 0}; }

  constexpr void advance(Increment increment) {
    const std::int64_t sum = fraction + (increment & (kOneCount - 1));
    counts += (increment >> kFractionBits) + (sum >> kFractionBits);
    fraction = sum & (kOneCount - 1);
  }

  constexpr bool operator==(const CountPosition&) const = default;

  constexpr bool operator<(const CountPosition& other) const {
    return counts != other.counts ? counts < other.counts : fraction < other.fraction;
  }

  constexpr CountPosition operator-(const CountPosition& other) const {
    const std::int64_t difference = fraction - other.fraction;
    return {counts - other.counts + (difference >> kFractionBits), difference & (kOneCount - 1)};
  }
};

/// Whole counts from `first` to `last`, by one comparison.
class CountRange {
 public:
  constexpr CountRange() = default;  ///< all counts
  constexpr CountRange(std::int64_t first, std::int64_t last)
      : first_(static_cast<std::uint64_t>(first)), span_(static_cast<std::uint64_t>(last) - first_) {
    if (last < first) {  // empty range: one count that no axis reaches
      first_ = std::uint64_t{1} << 63;
      span_ = 0;
    }
  }
  constexpr bool contains(std::int64_t counts) const { return static_cast<std::uint64_t>(counts) - first_ <= span_; }

 private:
  std::uint64_t first_ = 0;
  std::uint64_t span_ = std::numeric_limits<std::uint64_t>::max();
};

/// Distance from a whole count to a position, in counts, as a scalar; limited to +-2^31 counts.
template <typename Scalar>
constexpr Scalar counts_from(std::int64_t origin, const CountPosition& position) {
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  const std::int64_t distance = position.counts - origin;
  auto whole = static_cast<std::int32_t>(distance);
  if (whole != distance) whole = distance < 0 ? -kMost : kMost;
  return ScalarTraits<Scalar>::from_integer(whole) + ScalarTraits<Scalar>::from_fraction(position.fraction);
}

/// The same for a position nearer than 2^31 counts.
template <typename Scalar>
constexpr Scalar counts_near(std::int64_t origin, const CountPosition& position) {
  return ScalarTraits<Scalar>::from_integer(static_cast<std::int32_t>(position.counts - origin)) +
         ScalarTraits<Scalar>::from_fraction(position.fraction);
}

/// Extends a counter that wraps at 2^32 to 64 bits, starting from a reading in -2^31..2^31-1. Correct if it moves less
/// than 2^31 counts between two readings.
class CountExtender {
 public:
  constexpr std::int64_t extend(std::uint32_t reading) {
    advance(reading);
    return counts_;
  }

  /// The same; returns the travel since the last reading.
  constexpr std::int32_t advance(std::uint32_t reading) {
    const auto travel = static_cast<std::int32_t>(reading - last_reading_);
    last_reading_ = reading;
    counts_ += travel;
    return travel;
  }

  /// Assumes the same travel as in the last sample for the next one, whatever the counter does.
  constexpr void skip(std::int32_t travel) {
    last_reading_ += static_cast<std::uint32_t>(travel);
    counts_ += travel;
  }

  /// The extended position of a reading near the last one.
  constexpr std::int64_t counts_at(std::uint32_t reading) const {
    return counts_ + static_cast<std::int32_t>(reading - last_reading_);
  }

  /// Moves the origin: the former position 0 becomes `by`.
  constexpr void shift(std::int64_t by) { counts_ += by; }

  constexpr std::int64_t counts() const { return counts_; }
  constexpr std::uint32_t last_reading() const { return last_reading_; }

 private:
  std::int64_t counts_ = 0;
  std::uint32_t last_reading_ = 0;
};

}  // namespace firmware
