#include "host/demo/tracking.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/hil/closed_loop.hpp"
#include "host/hil/simulated_experiment.hpp"
#include "host/report/text_format.hpp"

namespace host {

namespace {

constexpr std::uint64_t kSeed = 7;
constexpr double kStep_mm = 0.1;
constexpr double kJog_mm_s = 100.0;

struct Variant {
  const char* name;
  bool friction, cancellation, zero_phase;
};
constexpr Variant kVariants[] = {
    {"state feedback", false, false, false},
    {"+ friction feed-forward", true, false, false},
    {"+ disturbance cancellation", true, true, false},
    {"+ zero-phase feed-forward", true, true, true},
};

firmware::AxisParameters<float> parameters_of(const sim::DriveDescription& identified, const AxisDesign& design,
                                              const Variant& variant) {
  auto parameters = axis_parameters(identified, design, hal::pc::AxisWiring{}.tachometer_resolution);
  parameters.friction_feedforward_on = variant.friction;
  parameters.disturbance_cancellation_on = variant.cancellation;
  parameters.zero_phase_feedforward_on = variant.zero_phase;
  return parameters;
}

Record run_jog(const sim::DriveDescription& machine, const firmware::AxisParameters<float>& parameters) {
  ClosedLoop loop(machine, parameters, kSeed);
  loop.run(0.1);
  for (const double speed : {kJog_mm_s, -kJog_mm_s, 0.0}) {
    loop.jog(speed);
    loop.run(0.4);
  }
  return loop.take();
}

Record run_step(const sim::DriveDescription& machine, const firmware::AxisParameters<float>& parameters) {
  ClosedLoop loop(machine, parameters, kSeed);
  loop.run(0.05);
  loop.step_reference(kStep_mm);
  loop.run(0.25);
  return loop.take();
}

std::vector<double> error_um(const Record& record) {
  std::vector<double> error(record.size());
  for (std::size_t k = 0; k < record.size(); ++k) error[k] = 1e3 * (record.x_ref[k] - record.x[k]);
  return error;
}

double worst(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

DemoPart show_tracking(const sim::DriveDescription& machine, const sim::DriveDescription& identified, Report& report) {
  const AxisDesign design = design_axis(identified, {});
  report.section(
      fmt::format("Axis {}: closed loop with the designed gains", machine.name),
      fmt::format("The controller is designed from the identified model only: poles at {:g} Hz, damping {:g}; "
                  "Kc = {} V/mm, {} V s/rad; estimator at {} to {} Hz.",
                  design.used.bandwidth_Hz, design.used.damping, format_value(design.Kc(0), 4),
                  format_value(design.Kc(1), 4), format_value(design.observer_fn_Hz.front(), 3),
                  format_value(design.observer_fn_Hz.back(), 3)));

  BarChart bars{"Largest tracking error of that jog", "", "µm", {{"largest error", SeriesRole::after}}, {}, {}};
  TimePlot jogs;
  jogs.title = fmt::format("Jog at ±{:g} mm/s", kJog_mm_s);
  jogs.caption = "Above: the speed follows its reference. Below: position error without and with all compensations.";
  std::vector<double> errors_um;
  for (const Variant& variant : kVariants) {
    const Record record = run_jog(machine, parameters_of(identified, design, variant));
    std::vector<double> error = error_um(record);
    errors_um.push_back(worst(error));
    bars.rows.push_back({variant.name, {errors_um.back()}, ""});
    if (&variant == &kVariants[0]) {
      jogs.t_s = record.t_s;
      jogs.panels.push_back({"position error", "µm", {{variant.name, SeriesRole::before, std::move(error)}}});
    } else if (&variant == std::end(kVariants) - 1) {
      jogs.panels.back().traces.push_back({"everything on", SeriesRole::after, std::move(error)});
      jogs.panels.insert(jogs.panels.begin(), TracePanel{"speed",
                                                         "rad/s",
                                                         {{"measured", SeriesRole::measured, record.w},
                                                          {"reference", SeriesRole::model, record.w_ref}}});
    }
  }
  report.add(std::move(jogs));
  report.add(std::move(bars));

  const Record step = run_step(machine, parameters_of(identified, design, kVariants[2]));
  TimePlot plot;
  plot.title = fmt::format("Step of {:g} µm", 1e3 * kStep_mm);
  plot.caption = "The reference jumps; friction feed-forward and disturbance cancellation are on.";
  plot.t_s = step.t_s;
  plot.panels = {
      {"position", "mm", {{"measured", SeriesRole::measured, step.x}, {"reference", SeriesRole::model, step.x_ref}}},
      {"command", "V", {{"D/A converter", SeriesRole::other, step.u_V}}}};
  report.add(std::move(plot));

  const double rest_error_um = std::abs(error_um(step).back());
  const double count_um = 1e3 * machine.data.encoder_resolution;
  std::vector<DemoFigure> figures = {
      {fmt::format("{} jog error with everything on, µm", machine.name), errors_um.back(), 0.0, errors_um.front(),
       fmt::format("below feedback alone, {}", format_value(errors_um.front(), 3))},
      at_most(fmt::format("{} position error after the step, µm", machine.name), rest_error_um, 2.0 * count_um)};
  return {
      fmt::format("Axis {} in closed loop: a jog at {:g} mm/s stays within {} µm with state feedback alone, {} µm with "
                  "everything on.",
                  machine.name, kJog_mm_s, format_value(errors_um.front(), 2), format_value(errors_um.back(), 2)),
      std::move(figures)};
}

}  // namespace host
