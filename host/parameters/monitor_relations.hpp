// The violated relation between a monitor's threshold and the axis's parameters, with values that would fit.
#pragma once

#include <string>

#include "firmware/core/axis_check.hpp"

namespace host {

/// Each function describes the first violated relation of firmware::check_monitors for monitor.overspeed,
/// monitor.disagreement with monitor.encoder_jump, or monitor.following_error. Values are in the parameters' own units.
std::string overspeed_relation(const firmware::AxisParameters<float>& p);
std::string disagreement_relation(const firmware::AxisParameters<float>& p);
std::string following_error_relation(const firmware::AxisParameters<float>& p);

}  // namespace host
