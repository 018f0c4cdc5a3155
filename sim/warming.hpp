// Common parts of the effects of warming up.
#pragma once

#include <string_view>

#include "sim/decay.hpp"
#include "sim/drive_description.hpp"
#include "sim/effect.hpp"

namespace sim {

/// 1 - exp(-(t - t0)/tau) with the entry's t0 and tau; t on the clock of the records, s.
class Warming {
 public:
  explicit Warming(const EffectEntry& entry)
      : time_constant_s_(entry.at("time_constant")), cold_s_(entry.has("cold_start") ? entry.at("cold_start") : 0.0) {}

  double operator()(double t_s) const { return 1.0 - decay((t_s - cold_s_) / time_constant_s_); }

 private:
  double time_constant_s_, cold_s_;
};

inline ParameterInfo cold_start_parameter(std::string_view doc) {
  return {.id = "cold_start",
          .rotary_key = "cold_start_s",
          .linear_key = "cold_start_s",
          .doc = doc,
          .lower = -1e10,
          .upper = 1e10,
          .scale = Scale::first_stamp,
          .starts = {1.0},
          .optional = true};
}

}  // namespace sim
