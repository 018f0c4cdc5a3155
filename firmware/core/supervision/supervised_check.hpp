// Checks all parameters before a supervised axis takes them.
#pragma once

#include "firmware/core/axis_check.hpp"
#include "firmware/core/control/pole_check.hpp"
#include "firmware/core/supervision/monitor_check.hpp"

namespace firmware {

/// The first check that fails.
template <typename Scalar>
constexpr Refusal check_supervised(const AxisParameters<Scalar>& parameters) {
  Refusal error = check(parameters);
  if (error == Refusal::none) error = check_homing(parameters.homing);
  if (error == Refusal::none) error = check_sequence(parameters.sequence);
  // An axis with a brake may fall. At rest only these two reveal a dead encoder.
  const bool watches_encoder = parameters.tachometer_fitted || parameters.encoder_fault_input;
  if (error == Refusal::none && parameters.sequence.brake_fitted && !watches_encoder) error = Refusal::brake_feedback;
  if (error == Refusal::none) error = check_monitors(parameters);
  if (error == Refusal::none) error = check_poles(parameters);
  return error;
}

}  // namespace firmware
