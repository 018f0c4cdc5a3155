// Headroom of a path's clock: how much faster a part of the path could run within the limits of acceleration and jerk.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace firmware {

/// Every path is planned so that it would keep the axes' limits at this rate too: a path at its limits could not be
/// slowed down without exceeding them.
inline constexpr double kLeastHeadroom = 1.01;

/// The highest rate at which a part of a path keeps the limits, by a node's headroom number. 6 numbers per octave;
/// values between two use the lower.
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
