// Sines by table: for sums of many, which turn_sine.hpp would make too slow.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "firmware/core/compensation/turn_sine.hpp"

namespace firmware {

namespace sine_table {

inline constexpr int kTableBits = 9;
inline constexpr std::size_t kParts = std::size_t{1} << kTableBits;

/// In double precision, while compiling. The series ends when its terms do, at a quarter turn after the eleventh.
constexpr double sine(double turns) {
  if (turns > 0.75) return sine(turns - 1.0);
  if (turns > 0.25) return sine(0.5 - turns);
  const double x = 6.283185307179586477 * turns;
  double term = x, sum = x;
  for (int n = 1; n < 12; ++n) {
    term *= -x * x / ((2 * n) * (2 * n + 1));
    sum += term;
  }
  return sum;
}

inline constexpr int kFraction = 21;  ///< bits that every scalar holds

/// A value, and its change to the next; in float by the least fraction.
template <typename Scalar>
struct Part {
  Scalar value{}, slope{};
};

/// Fixed point would not hold so small a slope.
template <typename Scalar>
inline constexpr std::int32_t kPerSlope = std::is_floating_point_v<Scalar> ? 1 << kFraction : 1;

template <typename Scalar>
consteval std::array<Part<Scalar>, kParts> make() {
  std::array<Part<Scalar>, kParts> table{};
  const auto scalar = [](double value) {
    if constexpr (requires { Scalar::from(value); })
      return Scalar::from(value);
    else
      return static_cast<Scalar>(value);
  };
  for (std::size_t i = 0; i < kParts; ++i) {
    const double here = sine(static_cast<double>(i) / kParts), next = sine(static_cast<double>(i + 1) / kParts);
    table[i] = {scalar(here), scalar((next - here) / kPerSlope<Scalar>)};
  }
  return table;
}

template <typename Scalar>
inline constexpr std::array<Part<Scalar>, kParts> kTable = make<Scalar>();

}  // namespace sine_table

/// Within 1.9e-5, (2 pi / 512)^2 / 8: straight lines between the table's values.
template <typename Scalar>
constexpr Scalar quick_sine_of(Turn turn) {
  using namespace sine_table;
  constexpr Turn kMask = (Turn{1} << kFraction) - 1;
  const Part<Scalar>& part = kTable<Scalar>[turn >> (32 - kTableBits)];
  const auto fraction = static_cast<std::int32_t>(turn >> (32 - kTableBits - kFraction) & kMask);
  if constexpr (std::is_floating_point_v<Scalar>)
    return part.value + static_cast<Scalar>(fraction) * part.slope;
  else
    return part.value + ScalarTraits<Scalar>::times(fraction, Scalar(1.0f / (1 << kFraction))) * part.slope;
}

}  // namespace firmware
