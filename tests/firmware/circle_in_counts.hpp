// A circle as a path, known in closed form.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "firmware/core/path/path_node.hpp"

namespace firmware_test {

/// A whole circle, from rest to rest by a polynomial of fifth degree in time: position, velocity and acceleration at
/// any sample, exactly.
struct Circle {
  double radius, samples;

  std::array<double, 3> turned(double sample) const {
    const double u = std::clamp(sample / samples, 0.0, 1.0), whole = 2.0 * std::numbers::pi;
    return {whole * u * u * u * (10.0 + u * (-15.0 + 6.0 * u)),
            whole * u * u * (30.0 + u * (-60.0 + 30.0 * u)) / samples,
            whole * u * (60.0 + u * (-180.0 + 120.0 * u)) / (samples * samples)};
  }
  double at(std::size_t axis, double sample) const {
    const double angle = turned(sample)[0];
    return radius * (axis == 0 ? 1.0 - std::cos(angle) : std::sin(angle));
  }
  double velocity(std::size_t axis, double sample) const {
    const auto t = turned(sample);
    return radius * t[1] * (axis == 0 ? std::sin(t[0]) : std::cos(t[0]));
  }
  double acceleration(std::size_t axis, double sample) const {
    const auto t = turned(sample);
    return radius * (axis == 0 ? t[2] * std::sin(t[0]) + t[1] * t[1] * std::cos(t[0])
                               : t[2] * std::cos(t[0]) - t[1] * t[1] * std::sin(t[0]));
  }
  double off(double x, double y) const { return std::abs(std::hypot(x - radius, y) - radius); }

  /// `given`: travels in units up to the previous node; updated to this node.
  firmware::PathNode<2> node(double sample, double piece, const firmware::PathUnits& units, bool last,
                             std::array<std::int64_t, 2>& given) const {
    firmware::PathNode<2> made;
    made.set_time(static_cast<std::uint32_t>(std::lround(piece * (1 << firmware::kPathTimeBits))));
    const auto word = [](double value, int bits) {
      return static_cast<std::int32_t>(std::llround(std::ldexp(value, bits)));
    };
    for (std::size_t i = 0; i < 2; ++i) {
      const auto there = std::llround(std::ldexp(at(i, sample), units.travel_bits));
      made.axis[i].travel = static_cast<std::int32_t>(there - given[i]);
      given[i] = there;
      if (last) continue;
      made.axis[i].velocity = word(velocity(i, sample), units.velocity_bits);
      made.axis[i].acceleration = word(acceleration(i, sample), units.acceleration_bits);
    }
    return made;
  }
};

}  // namespace firmware_test
