// The parameter that limits a refused motion, and its value.
#pragma once

#include "firmware/app/parameters/parameter_check.hpp"
#include "firmware/app/protocol/excitation_messages.hpp"
#include "firmware/core/motion/move_plan.hpp"

namespace firmware {

template <parameter_rows::Name name>
constexpr RefusedValuePayload limit_reply(const ParameterValues& values, std::size_t axis) {
  return {.key = ParameterKey::of_axis(axis, parameter_check::id_of<name>()).code,
          .kind = static_cast<std::uint8_t>(ValueRefusal::above_maximum),
          .bits = std::bit_cast<std::uint32_t>(static_cast<float>(values.axis(axis).template get<name>()))};
}

/// Allowed share of the velocity limit for an axis that is not homed, in parts of kWholeVelocity.
constexpr std::int32_t unhomed_share(const AxisValues& v) {
  const float most = v.get<"limits.unhomed_velocity">(), usual = v.get<"limits.velocity">();
  if (!(most > 0 && most < usual)) return kWholeVelocity;
  return static_cast<std::int32_t>(static_cast<float>(kWholeVelocity) * (most / usual));
}
/// `velocity`: of a jog, mm/s (m/s).
constexpr bool exceeds_unhomed_limit(float velocity, const AxisValues& v) {
  const float most = v.get<"limits.unhomed_velocity">();
  return most > 0 && (velocity > most || velocity < -most);
}

/// Limits of an axis that is not fitted, which has no thresholds from a design. They apply whatever the request's box
/// is.
constexpr bool exceeds_unfitted_limits(const ExcitationRequest& r, const ParameterValues& values,
                                       RefusedValuePayload& refused) {
  const AxisValues v = values.axis(r.axis);
  const float rate_Hz = static_cast<float>(values.get<"control.rate">());
  if (r.volts * v.get<"drive.dac_resolution">() > v.get<"unfitted.volts">())
    refused = limit_reply<"unfitted.volts">(values, r.axis);
  else if (static_cast<float>(r.samples) > v.get<"unfitted.time">() * rate_Hz)
    refused = limit_reply<"unfitted.time">(values, r.axis);
  else if (static_cast<float>(r.travel_counts) > static_cast<float>(v.get<"unfitted.counts">()))
    refused = limit_reply<"unfitted.counts">(values, r.axis);
  else
    return false;
  return true;
}

}  // namespace firmware
