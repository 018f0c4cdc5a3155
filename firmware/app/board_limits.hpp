// The board's own limits, from its parameters.
#pragma once

#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/core/supervision/board_watch.hpp"

namespace firmware {

inline BoardLimits board_limits(const ParameterValues& values) {
  const auto rate_Hz = static_cast<float>(values.get<"control.rate">());
  BoardLimits limits = BoardWatch::default_limits(1.0F / rate_Hz);
  limits.heartbeat_samples = static_cast<std::int32_t>(values.get<"host.timeout">() * rate_Hz);
  limits.stop_samples = static_cast<std::int32_t>(values.get<"emergency_stop.delay">() * rate_Hz);
  limits.standing_samples = static_cast<std::int32_t>(values.get<"host.standing_timeout">() * rate_Hz);
  return limits;
}

}  // namespace firmware
