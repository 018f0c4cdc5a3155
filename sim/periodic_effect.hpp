// Common parts of the effects that repeat along the travel.
#pragma once

#include <string_view>

#include "sim/effect.hpp"

namespace sim {

inline ParameterInfo period_parameter() {
  return {.id = "period",
          .rotary_key = "period_mm",
          .linear_key = "period_m",
          .doc = "L: travel of one period",
          .lower = 1e-5,
          .upper = 1e5,
          .scale = Scale::millimetre};
}

/// Parameter of a position error: its cosine or its sine.
inline ParameterInfo position_error_parameter(bool is_cosine) {
  return {.id = is_cosine ? "cosine" : "sine",
          .rotary_key = is_cosine ? "cosine_mm" : "sine_mm",
          .linear_key = is_cosine ? "cosine_m" : "sine_m",
          .doc = is_cosine ? "c" : "s",
          .lower = -1.0,
          .upper = 1.0,
          .scale = Scale::millimetre,
          .starts = {0.002}};
}

}  // namespace sim
