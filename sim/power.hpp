// x^p for one exponent p and many x, in the innermost loop of every simulation whose friction follows a power law.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace sim {

/// Powers with a fixed exponent within 1e-13 relative, for 0.2 <= |exponent| <= 3 and any x > 0: a table of the powers
/// of two, a table over the mantissa, and six terms of the binomial series, whose first missing one is below
/// (1/66)^7.
class Power {
 public:
  explicit Power(double exponent) : exponent_(exponent) {
    for (int k = 0; k < kOctaves; ++k) of_octave_[k] = std::exp2(exponent * (k + kLowest));
    for (int k = 0; k < kCells; ++k) of_cell_[k] = std::pow(1.0 / kPerMiddle[k], exponent);
    double binomial = 1.0;
    for (int k = 0; k < kTerms; ++k) series_[k] = binomial *= (exponent - k) / (k + 1);
  }

  double operator()(double x) const {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const int octave = static_cast<int>(bits >> 52) - 1023 - kLowest;
    if (octave < 0 || octave >= kOctaves) return std::pow(x, exponent_);
    const std::size_t cell = (bits >> (52 - kCellBits)) & (kCells - 1);
    const double mantissa = std::bit_cast<double>((bits & 0x000fffffffffffff) | 0x3ff0000000000000);
    const double d = mantissa * kPerMiddle[cell] - 1.0, dd = d * d;
    const double series = (1.0 + d * series_[0]) +
                          dd * ((series_[1] + d * series_[2]) + dd * ((series_[3] + d * series_[4]) + dd * series_[5]));
    return of_octave_[octave] * of_cell_[cell] * series;
  }

 private:
  static constexpr int kCellBits = 5, kCells = 1 << kCellBits, kTerms = 6;
  static constexpr int kLowest = -24, kOctaves = 40;  // 6e-8 to 6.5e4: beyond it the library's function is used
  static constexpr auto kPerMiddle = [] {
    std::array<double, kCells> values{};
    for (int k = 0; k < kCells; ++k) values[k] = kCells / (kCells + k + 0.5);
    return values;
  }();

  double exponent_;
  std::array<double, kOctaves> of_octave_{};
  std::array<double, kCells> of_cell_{};
  std::array<double, kTerms> series_{};
};

}  // namespace sim
