// The sum of sines of fixed frequencies, sample by sample: each line is an oscillator, so no sine is computed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "firmware/core/arithmetic/hide_origin.hpp"
#include "firmware/core/arithmetic/scalar.hpp"
#include "firmware/core/excitation/excitation_plan.hpp"

namespace firmware {

namespace line_bank {

/// sin(pi/2 z), both with 31 binary places, -1 <= z <= 1. The power series up to the fifteenth power leaves 6e-12.
constexpr std::int64_t sine_of_quarters(std::int64_t z) {
  constexpr auto with_places = [](double value) {
    return static_cast<std::int64_t>(value * 2147483648.0 + (value < 0.0 ? -0.5 : 0.5));
  };
  constexpr std::array kTerms = {with_places(-6.688035109811468e-10), with_places(5.692172921967926e-08),
                                 with_places(-3.598843235212085e-06), with_places(1.6044118478735983e-04),
                                 with_places(-4.681754135318687e-03), with_places(7.969262624616703e-02),
                                 with_places(-0.6459640975062462),    with_places(1.5707963267948966)};
  constexpr std::int64_t kHalf = std::int64_t{1} << 30;
  const std::int64_t zz = (z * z + kHalf) >> 31;
  std::int64_t sum = 0;
  for (const std::int64_t term : kTerms) sum = ((sum * zz + kHalf) >> 31) + term;
  return (sum * z + kHalf) >> 31;
}

constexpr std::int64_t sine_of_turn(Turn turn) {
  const Turn folded = turn > kQuarterTurn && turn < 3 * kQuarterTurn ? 2 * kQuarterTurn - turn : turn;
  return sine_of_quarters(std::int64_t{static_cast<std::int32_t>(folded)} * 2);
}

/// a * b / 2^32, downwards: one instruction.
constexpr std::int32_t upper_product(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>((static_cast<std::int64_t>(a) * b) >> 32);
}

}  // namespace line_bank

/// Each line turns by its angle a sample: with e = 2 sin(angle / 2), c -= e s and then s += e c gives s = sin of that
/// frequency exactly, and c = cos half a sample earlier; rounding changes neither frequency nor amplitude as time goes
/// on (the circle algorithm, HAKMEM item 149). Whole numbers of 2^-30 of the sum of all amplitudes: the same on every
/// machine. A line's angle is within 2^-30 / cos(angle / 2) of the requested one, below half a turn.
template <typename Scalar>
class LineBank {
 public:
  /// Starts from the beginning. Divides, and takes a hundred instructions per line: for the background.
  constexpr void prepare(const ExcitationEntry<Scalar>* entries, std::size_t count) {
    using namespace line_bank;
    std::int64_t total = 0;
    for (std::size_t i = 0; i < count; ++i) total += Traits::to_increment(Traits::magnitude(entries[i].value));
    unit_ = (total >> 30) + 1;
    scalar_unit_ = Traits::from_increment(unit_);
    at_ = begin_ = {};
    half_step_ = {};
    for (std::size_t i = 0; i < count; ++i) {
      const ExcitationEntry<Scalar>& entry = entries[i];
      const std::int64_t size = Traits::to_increment(entry.value) / unit_;
      const Turn earlier = entry.second - entry.first / 2;
      at_[i] = begin_[i] = pair(static_cast<std::int32_t>(size * sine_of_turn(entry.second) >> 31),
                                static_cast<std::int32_t>(size * sine_of_turn(earlier + kQuarterTurn) >> 31));
      // A line can turn by at most half a turn per sample; a larger angle turns the other way.
      const std::int64_t quarters =
          entry.first <= 2 * kQuarterTurn ? entry.first : (std::int64_t{1} << 32) - entry.first;
      constexpr std::int64_t kMost = (std::int64_t{1} << 31) - 1;
      const std::int64_t half_step = sine_of_quarters(quarters);
      const auto bounded = static_cast<std::int32_t>(half_step < kMost ? half_step : kMost);
      half_step_[i / 2] |= i % 2 == 0 ? pair(bounded, 0) : pair(0, bounded);
    }
  }

  /// `begins_anew`: the sample after this one is the first again.
  constexpr Scalar next(bool begins_anew) {
    using line_bank::upper_product;
    std::int32_t sum = 0;
    const auto turn = [&sum](std::uint64_t& at, std::int32_t half_step) {
      const std::int32_t sine = first(at);
      const std::int32_t cosine = second(at) - upper_product(half_step, sine) * 4;
      at = pair(sine + upper_product(half_step, cosine) * 4, cosine);
      sum += sine;
      hide_origin(sum);  // otherwise the compiler keeps all sines and adds them at the end
    };
    if (begins_anew) {
      for (const std::uint64_t at : at_) sum += first(at);
      at_ = begin_;
    } else {
      // All lines, used or not, because a loop would take longer.
#pragma GCC unroll 16
      for (std::size_t i = 0; i < half_step_.size(); ++i) {
        turn(at_[2 * i], first(half_step_[i]));
        turn(at_[2 * i + 1], second(half_step_[i]));
      }
    }
    if constexpr (std::is_floating_point_v<Scalar>)
      return Traits::times(sum, scalar_unit_);
    else
      return Traits::from_increment(sum * unit_);
  }

 private:
  using Traits = ScalarTraits<Scalar>;
  /// Words are stored in pairs, which the processor reads and writes at once.
  static constexpr std::uint64_t pair(std::int32_t first, std::int32_t second) {
    return std::uint64_t{static_cast<std::uint32_t>(second)} << 32 | static_cast<std::uint32_t>(first);
  }
  static constexpr std::int32_t first(std::uint64_t pair) { return static_cast<std::int32_t>(pair); }
  static constexpr std::int32_t second(std::uint64_t pair) { return static_cast<std::int32_t>(pair >> 32); }

  static_assert(kExcitationEntries % 2 == 0);
  std::array<std::uint64_t, kExcitationEntries> at_{}, begin_{};   ///< sine and cosine of each line
  std::array<std::uint64_t, kExcitationEntries / 2> half_step_{};  ///< sin(angle / 2) of two lines, 2^-31
  std::int64_t unit_ = 1;                                          ///< increment that corresponds to 1
  Scalar scalar_unit_{};
};

}  // namespace firmware
