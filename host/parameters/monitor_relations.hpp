// The violated relation between a monitor's threshold and the axis, with its figures and values that would fit.
#pragma once

#include <string>

#include "firmware/core/axis_check.hpp"

namespace host {

/// Of monitor.overspeed, of monitor.disagreement with monitor.encoder_jump, of monitor.following_error: the first
/// relation that does not hold, as firmware::check_monitors has them. Figures in the parameters' own units.
std::string overspeed_relation(const firmware::AxisParameters<float>& p);
std::string disagreement_relation(const firmware::AxisParameters<float>& p);
std::string following_error_relation(const firmware::AxisParameters<float>& p);

}  // namespace host
