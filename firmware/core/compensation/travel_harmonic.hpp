// One sine over the travel, at a position that never loses resolution.
#pragma once

#include "firmware/core/arithmetic/count_position.hpp"
#include "firmware/core/compensation/turn_sine.hpp"

namespace firmware {

/// cosine * cos(2 pi x/L) + sine * sin(2 pi x/L); x: counts since the counter was 0.
template <typename Scalar>
struct TravelHarmonic {
  Scalar cosine{};
  Scalar sine{};
  Increment turns_per_count{};  ///< 1/L in 2^-48 turns a count, below half a turn

  constexpr bool is_zero() const { return cosine == Scalar(0) && sine == Scalar(0); }

  constexpr Scalar operator()(const CountPosition& x) const {
    const Turn turn = turn_at(x);
    return cosine * sine_of<Scalar>(turn + kQuarterTurn) + sine * sine_of<Scalar>(turn);
  }

  constexpr Turn turn_at(const CountPosition& x) const {
    // Whole counts: exact modulo one turn, however far. Of the fraction of a count 32 bits are enough.
    const auto step = static_cast<std::uint64_t>(turns_per_count);
    const std::uint64_t whole = static_cast<std::uint64_t>(x.counts) * step;
    const std::uint64_t part = ((static_cast<std::uint64_t>(x.fraction) >> 16) * (step >> 16)) >> 16;
    return static_cast<Turn>((whole + part) >> 16);
  }
};

}  // namespace firmware
