// Sine of a part of a turn without the C library, whose results differ between newlib, picolibc and glibc.
#pragma once

#include <cstdint>

#include "firmware/core/arithmetic/scalar.hpp"

namespace firmware {

/// Part of a turn in units of 2^-32 turns, modulo a whole turn.
using Turn = std::uint32_t;

inline constexpr Turn kQuarterTurn = Turn{1} << 30;

/// Error below 4e-6 in float: the sine's power series ends with the ninth power, so the error is (pi/2)^11 / 11! =
/// 3.6e-6 at a quarter turn.
template <typename Scalar>
constexpr Scalar sine_of(Turn turn) {
  // The half turn around 1/2 is the mirror image of that around 0.
  if (turn > kQuarterTurn && turn < 3 * kQuarterTurn) turn = 2 * kQuarterTurn - turn;
  const auto quarters = std::int64_t{static_cast<std::int32_t>(turn)} << (kFractionBits - 30);
  const Scalar z = ScalarTraits<Scalar>::from_increment(quarters);  // -1..1
  const Scalar zz = z * z;
  Scalar sum = Scalar(0.000160441185f);  // (pi/2)^9 / 9!
  sum = sum * zz + Scalar(-0.00468175414f);
  sum = sum * zz + Scalar(0.0796926262f);
  sum = sum * zz + Scalar(-0.645964098f);
  sum = sum * zz + Scalar(1.57079633f);
  return sum * z;
}

}  // namespace firmware
