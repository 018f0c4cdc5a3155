// The state of an axis, for the host.
#pragma once

#include "firmware/app/channel_words.hpp"
#include "firmware/app/protocol/messages.hpp"

namespace firmware {

/// All values belong to one instant; the velocity is left out. `fitted`, `pitch_on`: from the parameters.
template <typename Axis>
AxisStatus axis_status(const Axis& axis, bool fitted, bool pitch_on) {
  AxisStatus status;
  const auto& seen = axis.telemetry();
  status.counts_low = static_cast<std::uint32_t>(seen.encoder_counts);
  status.counts_high = static_cast<std::int32_t>(seen.encoder_counts >> 32);
  status.state = static_cast<std::uint8_t>(axis.state());
  status.fault = static_cast<std::uint8_t>(axis.fault());
  status.second_fault = static_cast<std::uint8_t>(axis.latched().second());
  const auto limiting = axis.limiting();
  status.flags =
      static_cast<std::uint8_t>((fitted ? kAxisFitted : 0) | (limiting.saturated ? kAxisSaturated : 0) |
                                (limiting.velocity_limited ? kAxisVelocityLimited : 0) |
                                (axis.is_at_rest() && !axis.is_homing() ? kAxisAtRest : 0) |
                                (axis.is_homed() ? kAxisHomed : 0) | (axis.is_homing() ? kAxisHoming : 0) |
                                (pitch_on && axis.is_homed() ? kAxisPitch : 0) | (has_scale(axis) ? kAxisScale : 0));
  return status;
}

}  // namespace firmware
