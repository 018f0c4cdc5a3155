#include "host/demo/paper_axis.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/demo/model_plot.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/hil/simulated_experiment.hpp"
#include "host/identify/friction_identification.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/report/text_format.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

constexpr double kStepScaling = 15.0;  // Ku, p. 1499
constexpr std::uint64_t kStepSeed = 1, kJogSeed = 11;
constexpr double kPitch_mm = 10.0;
constexpr double kTachometerError = 1.01;

void add_step_methods(const Record& steps, const sim::DriveDescription& machine, Report& report) {
  const FrictionLaw truth = friction_law(machine);
  Table table;
  table.title = "Least squares at Ku = 15";
  table.caption = "Simple least squares ignores Coulomb friction, which biases B; the paper's method estimates both.";
  table.headings = {"method", "J, kg m²", "B, Nm s/rad", "Coulomb +, Nm", "Coulomb -, Nm", "torque error, %"};
  for (const auto method :
       {IdentificationMethod::simple_ls, IdentificationMethod::unbiased_ls, IdentificationMethod::sliding_ls}) {
    const Identification found =
        identify_drive(MeasurementGate(data_sheet_of(machine)).admit({steps}), data_sheet_of(machine), method);
    const RigidEstimate& e = found.estimate;
    table.rows.push_back({std::string(method_name(method)), fmt::format("{:.5f}", e.inertia.value),
                          fmt::format("{:.4f}", e.viscous.value),
                          e.positive ? fmt::format("{:.3f}", e.positive->value) : "–",
                          e.negative ? fmt::format("{:.3f}", e.negative->value) : "–",
                          fmt::format("{:.2f}", 100.0 * found.relative_error)});
  }
  table.rows.push_back({"Table 1", fmt::format("{:.5f}", rigid_axis(machine).inertia),
                        fmt::format("{:.4f}", truth.viscous), fmt::format("{:.3f}", truth.positive.coulomb),
                        fmt::format("{:.3f}", -truth.negative.coulomb), ""});
  report.add(std::move(table));
}

void add_jog_plot(const Record& jogs, const AxisDesign& design, const sim::DriveDescription& machine, Report& report) {
  std::vector<double> torque = observe_disturbance(jogs, design, machine.data);
  for (double& d : torque) d *= machine.data.effort_per_volt();
  TimePlot plot;
  plot.title = "Jogs at the paper's eleven speeds, and the disturbance estimated by the Kalman filter (as Fig. 9)";
  plot.caption =
      "Each plateau of the lower trace is one friction torque: larger at the slowest speeds (static friction).";
  plot.t_s = jogs.t_s;
  plot.panels = {{"speed", "rad/s", {{"measured", SeriesRole::measured, jogs.w}}},
                 {"disturbance", "Nm", {{"Kalman estimate", SeriesRole::other, std::move(torque)}}}};
  report.add(std::move(plot));
}

ScatterSeries curve_of(const FrictionLaw& law, const char* name, SeriesRole role, double top_speed) {
  ScatterSeries curve{name, role, SeriesStyle::line, {}, {}, {}, {}};
  for (int step = -200; step <= 200; ++step) {
    const double part = step / 200.0;
    const double speed = top_speed * part * std::abs(part);  // denser at low speeds, where the curve bends
    curve.x.push_back(speed);
    curve.y.push_back(step == 0 ? std::nan("") : law.effort(speed));
  }
  return curve;
}

void add_friction_plot(const FrictionIdentification& found, const sim::DriveDescription& machine, Report& report) {
  ScatterSeries points{"measured at constant speed", SeriesRole::measured, SeriesStyle::points, {}, {}, {}, {}};
  double top_speed = 0.0;
  for (const FrictionPoint& point : found.points) {
    if (!point.is_steady()) continue;
    points.x.push_back(point.speed);
    points.y.push_back(point.effort);
    points.lower.push_back(point.effort - kNormal95 * point.standard_error);
    points.upper.push_back(point.effort + kNormal95 * point.standard_error);
    top_speed = std::max(top_speed, std::abs(point.speed));
  }
  ScatterPlot plot;
  plot.title = "Friction curve (as Fig. 10)";
  plot.caption =
      "Points: mean torque at constant speed, with 95 % bars. Line: the fitted curve, over the plant's true curve.";
  plot.x = {"speed", "rad/s"};
  plot.y = {"friction torque", "Nm"};
  plot.series = {curve_of(friction_law(machine), "true (Table 1)", SeriesRole::other, top_speed),
                 curve_of(found.fit.law, "fitted", SeriesRole::model, top_speed), std::move(points)};
  report.add(std::move(plot));
}

double worst_curve_error(const FrictionLaw& found, const FrictionLaw& truth) {
  double worst = 0.0;
  constexpr double kSlowest_rad_s = 0.6, kFastest_rad_s = 63.0;  // range of the paper's jogs
  constexpr int kSpeeds = 240;
  for (int k = 0; k <= kSpeeds; ++k) {
    const double v = kSlowest_rad_s * std::pow(kFastest_rad_s / kSlowest_rad_s, static_cast<double>(k) / kSpeeds);
    for (const double speed : {v, -v}) worst = std::max(worst, std::abs(found.effort(speed) - truth.effort(speed)));
  }
  return worst;
}

std::vector<Jog> paper_jogs() {
  return jogging_programme({kPaperJogSpeeds_mm_s.begin(), kPaperJogSpeeds_mm_s.end()}, kPitch_mm);
}

void add_step_figures(const Identification& found, const sim::DriveDescription& machine, const std::string& axis,
                      std::vector<DemoFigure>& figures) {
  const FrictionLaw truth = friction_law(machine);
  const RigidEstimate& e = found.estimate;
  figures.push_back(within_fraction(axis + " inertia J, kg m²", e.inertia.value, rigid_axis(machine).inertia, 0.02));
  figures.push_back(within_fraction(axis + " viscous B from steps, Nm s/rad", e.viscous.value, truth.viscous, 0.20));
  figures.push_back(within_fraction(axis + " Coulomb forward, Nm", e.positive->value, truth.positive.coulomb, 0.12));
  figures.push_back(within_fraction(axis + " Coulomb backward, Nm", e.negative->value, -truth.negative.coulomb, 0.12));
}

/// The same jogs on a machine whose tachometer reads too high.
void add_tachometer_figures(const sim::DriveDescription& machine, const sim::DriveDescription& believed,
                            const AxisDesign& design, const std::string& axis, std::vector<DemoFigure>& figures) {
  sim::DriveDescription misread = machine;
  misread.effects.push_back({.kind = "tach_gain", .parameters = {{"gain", kTachometerError}}, .ci95 = {}, .from = {}});
  const Record jogs = record_jogs(misread, design, paper_jogs(), kJogSeed);
  const FrictionIdentification found =
      identify_friction(MeasurementGate(believed).admit({jogs}), believed, FrictionMethod::joint);
  const double gain = found.tachometer ? found.tachometer->gain.value : std::nan("");
  figures.push_back({axis + " tachometer gain, made 1 % wrong", gain, kTachometerError - 0.002,
                     kTachometerError + 0.002, "1.01 ± 0.2 %"});
  figures.push_back(within_fraction(axis + " B' with that tachometer, Nm s/rad", found.fit.law.viscous,
                                    friction_law(machine).viscous, 0.03));
}

}  // namespace

PaperAxisOutcome show_paper_axis(std::string_view axis, Report& report) {
  const sim::DriveDescription machine = *paper_drive(axis);
  const std::string name(axis);
  const Record steps =
      record_open_loop(machine, doublet_series(kStepScaling * kStepUnit_V, machine.data.sample_period_s), kStepSeed);
  const Identification unbiased = identify_drive(MeasurementGate(data_sheet_of(machine)).admit({steps}),
                                                 data_sheet_of(machine), IdentificationMethod::unbiased_ls);
  const Identification sliding = identify_drive(MeasurementGate(data_sheet_of(machine)).admit({steps}),
                                                data_sheet_of(machine), IdentificationMethod::sliding_ls);
  const AxisDesign design = design_axis(sliding.model, {});
  const Record jogs = record_jogs(machine, design, paper_jogs(), kJogSeed);
  FrictionIdentification friction =
      identify_friction(MeasurementGate(sliding.model).admit({jogs}), sliding.model, FrictionMethod::joint);

  PaperAxisOutcome outcome;
  const FrictionLaw truth = friction_law(machine);
  add_step_figures(unbiased, machine, name, outcome.part.figures);
  // Between 0.6 and 63 rad/s; the torque of the y axis is noisier.
  outcome.part.figures.push_back(at_most(name + " friction curve, worst error, Nm",
                                         worst_curve_error(friction.fit.law, truth), axis == "x" ? 0.015 : 0.03));
  outcome.part.figures.push_back(
      within_fraction(name + " viscous B' from jogs, Nm s/rad", friction.fit.law.viscous, truth.viscous, 0.02));
  add_tachometer_figures(machine, sliding.model, design, name, outcome.part.figures);

  report.section(
      fmt::format("Axis {}: open-loop steps", name),
      "Simulated plant with the values of Table 1 of the paper: friction with true sticking, quantised D/A converter "
      "and encoder, noisy tachometer.");
  const std::vector<double> modelled = free_run_speed(friction.model, steps);
  TimePlot plot = model_plot("speed", "rad/s", steps.t_s, steps.w, modelled);
  plot.title = "Measured and modelled speed (as Fig. 8)";
  plot.caption = fmt::format(
      "The identified model gets only the commands, from rest to the end without restart. Difference {} rad/s "
      "rms; "
      "the tachometer's own noise is {} rad/s.",
      format_value(rms_difference(steps.w, modelled), 2),
      format_value(std::sqrt(*machine.data.tach_noise_variance), 2));
  report.add(std::move(plot));
  add_step_methods(steps, machine, report);
  report.section(fmt::format("Axis {}: friction from jogs in closed loop", name));
  add_friction_plot(friction, machine, report);
  add_jog_plot(jogs, design, machine, report);
  outcome.part.sentence = fmt::format(
      "Axis {} of the paper, simulated: inertia {:.5f} kg m² (Table 1: {:.5f}); friction curve within {} Nm of the "
      "truth.",
      axis, unbiased.estimate.inertia.value, rigid_axis(machine).inertia,
      format_value(worst_curve_error(friction.fit.law, truth), 1));
  outcome.identified = std::move(friction.model);
  return outcome;
}

}  // namespace host
