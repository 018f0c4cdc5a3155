// How much faster a part of a path could be followed within the limits of acceleration and jerk: what its clock has.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace firmware {

/// Every path is planned so that it would keep the axes' limits at this rate too: a path at its limits could not be
/// slowed down at all without exceeding them.
inline constexpr double kLeastHeadroom = 1.01;

/// The highest rate at which a part of a path holds them, by the number that a node has for it. 6 numbers an
/// octave; what is in between counts as the lower.
inline constexpr std::array<double, 16> kHeadrooms = [] {
  constexpr double kStep = 1.122462048309373;  // 2^(1/6)
  std::array<double, 16> rates{};
  double rate = kLeastHeadroom;
  for (double& one : rates) {
    one = rate;
    rate *= kStep;
  }
  return rates;
}();

constexpr std::uint8_t headroom_number(double rate) {
  std::uint8_t number = 0;
  while (number + 1u < kHeadrooms.size() && kHeadrooms[number + 1u] <= rate) ++number;
  return number;
}

}  // namespace firmware
