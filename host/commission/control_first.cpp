// The first controller: pole placement on the identified drive, with modest bandwidth.
#include <fmt/format.h>

#include "host/commission/steps.hpp"
#include "host/commission/stopping_room.hpp"
#include "host/model/model_file.hpp"
#include "host/record/drive_units.hpp"

namespace host {

namespace {

/// Properties for stopping with these parameters. A brake's torque or force is unknown.
StoppingFigures figures_of(const CommissionSession& session, const sim::DriveDescription& model,
                           const firmware::AxisValues& values) {
  const ReferenceLimits limits = session.limits();
  StoppingFigures axis = stopping_figures(model, session.options().box.speed, limits.acceleration, limits.jerk);
  axis.brake = values.get<"brake.fitted">();
  axis.brake_time_s = static_cast<double>(values.get<"brake.apply_time">());
  return axis;
}

}  // namespace

CommissionStepResult control_first(CommissionSession& session) {
  const sim::DriveDescription model = read_model(session.folder().require("identified.toml", "identify"));
  session.plan_limits(model);
  const firmware::ParameterValues values = session.design(model, session.first_loop(model), "first-params.toml");
  const CommissionOptions& options = session.options();
  const firmware::AxisValues axis_values = values.axis(options.axis);
  const StoppingFigures axis = figures_of(session, model, axis_values);
  check_feedback_at_rest(axis, axis_values.get<"tachometer.fitted">() || axis_values.get<"encoder.fault_input">());
  const std::string stops =
      check_stopping_room(axis, options.box.speed, options.overtravel, units_of(model.data.kind).travel);
  session.download(values);
  return {{"first-params.toml"},
          fmt::format("Poles at {:.3g} Hz; the parameters are on the board but not saved. {}",
                      session.first_options().bandwidth_Hz, stops)};
}

}  // namespace host
