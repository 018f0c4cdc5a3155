// Notch and low-pass behind the feedback, against a resonance.
#pragma once

#include <array>
#include <cstddef>

#include "firmware/core/arithmetic/scalar.hpp"

namespace firmware {

/// Of a second-order filter with poles s^2 + 2 damping w s + w^2, in state-variable form by the trapezoidal rule
/// (Zavalishin, The Art of VA Filter Design, ch. 4), prewarped: g = tan(w Ts / 2), a1 = 1 / (1 + g (g + 2 damping)),
/// a2 = g a1, a3 = g a2. The coefficients keep their precision even if the filter is slow compared with the control
/// rate.
template <typename Scalar>
struct BiquadParameters {
  bool on = false;
  bool is_low_pass = false;  ///< otherwise a notch
  Scalar a1{}, a2{}, a3{};   ///< a1 in (0, 1)
  Scalar of_band{};          ///< of a notch: 2 damping (depth - 1); depth: gain at its frequency
};

inline constexpr std::size_t kControlFilters = 2;
template <typename Scalar>
using FilterParameters = std::array<BiquadParameters<Scalar>, kControlFilters>;

template <typename Scalar>
class ControlFilters {
 public:
  constexpr void configure(const FilterParameters<Scalar>& parameters) {
    parameters_ = parameters;
    is_on_ = false;
    for (const BiquadParameters<Scalar>& one : parameters) is_on_ = is_on_ || one.on;
    reset();
  }
  constexpr bool is_on() const { return is_on_; }
  /// Treats the next input as if it had been constant for long: the output equals it.
  constexpr void reset() { is_new_ = true; }

  [[gnu::noinline]] constexpr Scalar next(Scalar value) {
    for (std::size_t i = 0; i < kControlFilters; ++i) {
      const BiquadParameters<Scalar>& p = parameters_[i];
      if (!p.on) continue;
      State& state = state_[i];
      if (is_new_) state = {Scalar(0), value};
      const Scalar rest = value - state.low;
      const Scalar band = p.a1 * state.band + p.a2 * rest;
      const Scalar low = state.low + p.a2 * state.band + p.a3 * rest;
      state = {band + band - state.band, low + low - state.low};
      value = p.is_low_pass ? low : value + p.of_band * band;
    }
    is_new_ = false;
    return value;
  }

 private:
  struct State {
    Scalar band{}, low{};
  };
  FilterParameters<Scalar> parameters_{};
  std::array<State, kControlFilters> state_{};
  bool is_on_ = false, is_new_ = true;
};

}  // namespace firmware
