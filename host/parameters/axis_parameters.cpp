#include "host/parameters/axis_parameters.hpp"

#include "firmware/app/parameters/axis_values.hpp"
#include "host/parameters/parameter_names.hpp"

namespace host {

firmware::AxisParameters<float> axis_parameters(const sim::DriveDescription& model, const AxisDesign& design,
                                                double tachometer_resolution, const ReferenceLimits& limits) {
  firmware::ParameterValues values;
  const auto set = [&](const std::string& name, double value) {
    values.set(require_place("x." + name), static_cast<float>(value));
  };
  for (const BoardParameter& parameter : board_parameters(model, design, limits)) set(parameter.name, parameter.value);
  set("tachometer.gain", tachometer_resolution);
  for (const char* name : {"feedback.cancel_disturbance", "feedforward.zero_phase", "feedforward.friction"})
    set(name, 0.0);
  return firmware::axis_parameters<float>(values.axis(0));
}

}  // namespace host
