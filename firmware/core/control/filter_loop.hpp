// Checks that a loop with filters in its feedback is stable: algebra with bounded work, whatever the poles are.
#pragma once

#include <array>
#include <cstddef>

#include "firmware/core/control/control_filter.hpp"

namespace firmware {

/// Characteristic polynomial of a sampled loop, in delta = z - 1: D prod(A) + N prod(B), where N / D is the open loop
/// without filters and B / A each filter. All coefficients are positive, so that no digits cancel in single precision,
/// even if the poles are slow compared with the control rate.
class FilterLoop {
 public:
  using Quadratic = std::array<float, 3>;  ///< coefficients, the lowest power first

  constexpr FilterLoop(const Quadratic& denominator, const Quadratic& numerator) {
    for (std::size_t i = 0; i < 3; ++i) {
      open_[i] = denominator[i];
      fed_back_[i] = numerator[i];
    }
  }

  /// From BiquadParameters: s^2 + 2 damping s + 1 with s = delta / (g (2 + delta)), g = a2 / a1, is its denominator.
  constexpr void add(float a1, float a2, float of_band, bool is_low_pass) {
    const float g = a2 / a1, square = g * g;
    const float damped = (1.0f - a1) / a1 - square;  // 2 damping g
    const auto in_delta = [square](float s_square, float s) {
      return Quadratic{4.0f * square, 2.0f * s + 4.0f * square, s_square + s + square};
    };
    multiply(open_, in_delta(1.0f, damped));
    multiply(fed_back_, is_low_pass ? in_delta(0.0f, 0.0f) : in_delta(1.0f, damped + of_band * g));
    degree_ += 2;
  }

  /// Every mode shrinks by `share` a sample at least: 0 < share < 1. Routh's table of the polynomial in
  /// s = (z' - 1) / (z' + 1), z' = z / (1 - share).
  constexpr bool settles(float share) const {
    Polynomial p{};
    for (std::size_t i = 0; i <= degree_; ++i) p[i] = open_[i] + fed_back_[i];
    shift(p, -share);
    scale(p, 1.0f - share);
    return is_hurwitz(bilinear(p));
  }

 private:
  static constexpr std::size_t kMostDegree = 2 + 2 * kControlFilters;
  using Polynomial = std::array<float, kMostDegree + 1>;

  constexpr void multiply(Polynomial& p, const Quadratic& factor) const {
    for (std::size_t i = degree_ + 2;; --i) {
      float sum = 0.0f;
      for (std::size_t j = 0; j < 3 && j <= i; ++j)
        if (i - j <= degree_) sum += factor[j] * p[i - j];
      p[i] = sum;
      if (i == 0) return;
    }
  }

  /// p(x + by), by Horner's scheme.
  constexpr void shift(Polynomial& p, float by) const {
    for (std::size_t from = 0; from < degree_; ++from)
      for (std::size_t i = degree_; i-- > from;) p[i] += by * p[i + 1];
  }
  /// p(times x)
  constexpr void scale(Polynomial& p, float times) const {
    float power = 1.0f;
    for (std::size_t i = 0; i <= degree_; ++i, power *= times) p[i] *= power;
  }

  /// delta = 2 s / (1 - s), multiplied by (1 - s)^degree.
  constexpr Polynomial bilinear(const Polynomial& p) const {
    Polynomial result{};
    Polynomial power{1.0f};  // (1 - s)^(degree - k), from k = degree down
    for (std::size_t k = degree_ + 1; k-- > 0;) {
      for (std::size_t i = 0; i + k <= degree_; ++i) result[i + k] += p[k] * power_of_two(k) * power[i];
      for (std::size_t i = degree_; i > 0; --i) power[i] -= power[i - 1];
    }
    return result;
  }
  static constexpr float power_of_two(std::size_t exponent) { return static_cast<float>(1u << exponent); }

  /// All roots have negative real parts.
  constexpr bool is_hurwitz(Polynomial p) const {
    normalise(p);
    if (!(p[degree_] > 0.0f)) return false;
    // Each round removes the highest power; the first element must be positive.
    for (std::size_t top = degree_; top > 0; --top) {
      if (!(p[top - 1] > 0.0f)) return false;
      const float ratio = p[top] / p[top - 1];
      for (std::size_t i = top - 1; i >= 2; i -= 2) p[i - 1] -= ratio * p[i - 2];
    }
    return true;
  }

  /// Scales s so that the first and last coefficients have equal size: Routh's table then stays within a float's range.
  constexpr void normalise(Polynomial& p) const {
    if (!(p[0] > 0.0f) || !(p[degree_] > 0.0f)) return;
    float stretch = 1.0f;
    for (int n = 0; n < 24; ++n, stretch *= 0.5f) {
      float last = p[degree_];
      for (std::size_t i = 0; i < degree_; ++i) last *= stretch;
      if (last <= p[0]) break;
    }
    scale(p, stretch);
    const float largest = p[0];
    for (std::size_t i = 0; i <= degree_; ++i) p[i] /= largest;
  }

  Polynomial open_{}, fed_back_{};
  std::size_t degree_ = 2;
};

}  // namespace firmware
