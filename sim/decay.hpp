// exp(-z) from a table, in the innermost loop of every simulation with Stribeck friction.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace sim {

namespace decay_table {
constexpr double kPerUnit = 32.0;
constexpr double kEnd = 37.0;  // exp(-37) is below the rounding of 1
constexpr auto kValues = [] {
  constexpr double kRatio = 0x1.f03f56a88b5d8p-1;  // exp(-1/32)
  std::array<double, static_cast<std::size_t>(kEnd * kPerUnit) + 1> values{};
  double value = 1.0;
  for (double& each : values) {
    each = value;
    value *= kRatio;
  }
  return values;
}();
}  // namespace decay_table

/// exp(-z) for any z, within 1e-11 relative for 0 <= z < 37 and 0 beyond: the nearest value of the table times four
/// terms of the series, whose first missing one is (1/64)^5/120.
[[gnu::always_inline]] inline double decay(double z) {
  using decay_table::kEnd, decay_table::kPerUnit, decay_table::kValues;
  if (!(z < kEnd)) return z >= kEnd ? 0.0 : z;  // NaN stays NaN
  if (z < 0.0) return std::exp(-z);
  // Adding 1.5 * 2^52 rounds to a whole number, which is then in the lowest bits.
  constexpr double kRounder = 0x1.8p52;
  const double cells = z * kPerUnit, shifted = cells + kRounder;
  const std::size_t nearest = std::bit_cast<std::uint64_t>(shifted) & 0xfff;
  const double d = cells - (shifted - kRounder), dd = d * d;
  constexpr double c1 = 1.0 / kPerUnit, c2 = c1 * c1 / 2, c3 = c2 * c1 / 3, c4 = c3 * c1 / 4;
  return kValues[nearest] * ((1.0 - d * c1) + dd * ((c2 - d * c3) + dd * c4));
}

}  // namespace sim
