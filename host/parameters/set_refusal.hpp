// The reason why a set of parameters is refused, in words: the violated relation and its values.
#pragma once

#include <string>

#include "firmware/app/parameters/parameter_check.hpp"

namespace host {

/// Continues "x.feedback.k1 = ... does not go with the other parameters of its axis: "; empty if the parameter's
/// documentation is sufficient.
std::string why_refused(const firmware::ParameterValues& values, const firmware::SetRefusal& refused);

/// Poles of the sampled estimator and of the sampled loop, in the plane of z: "0.678, 0.694 +- 0.286i".
std::string estimator_poles_text(const firmware::AxisParameters<float>& p);
std::string loop_poles_text(const firmware::AxisParameters<float>& p);

}  // namespace host
