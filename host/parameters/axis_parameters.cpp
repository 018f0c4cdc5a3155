#include "host/parameters/axis_parameters.hpp"

#include "firmware/app/parameters/axis_values.hpp"
#include "host/parameters/parameter_names.hpp"

namespace host {

namespace {

firmware::ParameterValues values_of(const sim::DriveDescription& model, const AxisDesign& design,
                                    const ReferenceLimits& limits) {
  firmware::ParameterValues values;
  for (const auto& [name, value] : board_parameters(model, design, limits))
    values.set(require_place("x." + name), static_cast<float>(value));
  return values;
}

}  // namespace

firmware::AxisParameters<float> axis_parameters(const sim::DriveDescription& model, const AxisDesign& design,
                                                double tachometer_resolution, const ReferenceLimits& limits) {
  firmware::ParameterValues values = values_of(model, design, limits);
  values.set(require_place("x.tachometer.gain"), static_cast<float>(tachometer_resolution));
  for (const char* name : {"x.feedback.cancel_disturbance", "x.feedforward.zero_phase", "x.feedforward.friction"})
    values.set(require_place(name), 0.0F);
  return firmware::axis_parameters<float>(values.axis(0));
}

firmware::AxisParameters<float> designed_parameters(const sim::DriveDescription& model, const AxisDesign& design,
                                                    const ControlFilterChoice& filters,
                                                    const std::optional<ReferenceLimits>& limits) {
  auto parameters = firmware::axis_parameters<float>(
      values_of(model, design, limits.value_or(ReferenceLimits::usual_for(model.data.kind))).axis(0));
  parameters.filters = core_filters(filters, model.data.sample_period_s);
  return parameters;
}

Eigen::Matrix<double, 3, Eigen::Dynamic> estimator_of(const firmware::AxisValues& board) {
  Eigen::Matrix<float, 3, 2> gain;
  gain << board.get<"kalman.k11">(), board.get<"kalman.k12">(), board.get<"kalman.k21">(), board.get<"kalman.k22">(),
      board.get<"kalman.k31">(), board.get<"kalman.k32">();
  return gain.leftCols(board.get<"tachometer.fitted">() ? 2 : 1).cast<double>();
}

}  // namespace host
