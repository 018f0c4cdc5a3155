#include "host/hil/robustness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "firmware/app/parameters/axis_values.hpp"
#include "hal/pc/simulated_axis.hpp"
#include "host/exit_codes.hpp"
#include "host/hil/commissioning.hpp"
#include "host/hil/contouring.hpp"
#include "host/known_by_current.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/parameters/parameter_names.hpp"

namespace host {

namespace {

constexpr std::uint64_t kSeeds = 3;

void scale(sim::DriveDescription& drive, const std::set<std::string>& kinds, double percent) {
  for (sim::EffectEntry& effect : drive.effects)
    if (kinds.contains(effect.kind))
      for (auto& [id, value] : effect.parameters)
        if (!id.starts_with("omega")) value *= 1.0 + percent / 100.0;
}

void delay_by(sim::DriveDescription& drive, double periods) {
  const double more_s = periods * drive.data.sample_period_s;
  if (sim::EffectEntry* const known = drive.find("input_delay")) {
    known->parameters["delay"] += more_s;
    return;
  }
  if (more_s > 0.0)
    drive.effects.push_back({.kind = "input_delay", .parameters = {{"delay", more_s}}, .ci95 = {}, .from = {}});
}

struct Change {
  const char *quantity, *unit;
  std::vector<double> values;
  void (*apply)(sim::DriveDescription& drive, double value);
};

const std::vector<Change>& changes() {
  static const std::vector<Change> all = {
      {"inertia",
       "%",
       {-20.0, -10.0, 0.0, 10.0, 20.0},
       [](sim::DriveDescription& drive, double value) { scale(drive, {"inertia"}, value); }},
      {"friction",
       "%",
       {-30.0, -15.0, 0.0, 15.0, 30.0},
       [](sim::DriveDescription& drive, double value) {
         scale(drive, {"coulomb", "stribeck", "viscous"}, value);
       }},
      {"delay", "period", {0.0, 0.5, 1.0}, &delay_by}};
  return all;
}

firmware::AxisParameters<float> with_controller(firmware::AxisParameters<float> parameters, std::size_t controller) {
  parameters.zero_phase_feedforward_on = controller >= 1;
  parameters.friction_feedforward_on = controller >= 2;
  parameters.disturbance_cancellation_on = controller >= 3;
  if (!parameters.friction_feedforward_on) {  // these effects change the friction feed-forward
    parameters.compensation.presliding.on = false;
    parameters.compensation.position_friction_on = false;
  }
  return parameters;
}

ContourFigures circle(const std::array<MachineAxis, hal::kAxisCount>& axes, const RobustnessOptions& options,
                      const PathLimits& limits) {
  ContourFigures figures;
  try {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const ContouringRun run = run_contour(axes, Path::circle(options.radius_mm), limits, seed);
      double squares = 0.0, rows = 0.0;
      for (std::size_t k = 0; k < run.t_s.size(); ++k) {
        if (run.t_s[k] < run.begin_s || run.t_s[k] > run.end_s) continue;
        squares += run.contour_um[k] * run.contour_um[k];
        rows += 1.0;
      }
      figures.most_um += run.worst_contour_um() / kSeeds;
      figures.rms_um += std::sqrt(squares / rows) / kSeeds;
    }
  } catch (const Failure& failure) {
    if (failure.code != ExitCode::device_fault) throw;
    figures = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(), failure.what()};
  }
  return figures;
}

std::string change_text(const RobustnessCurve& curve, double change) {
  return fmt::format("{} {:+g} {}", curve.quantity, change, curve.unit);
}

std::string figure_text(const ContourFigures& one) {
  return one.fault.empty() ? fmt::format("{:.1f} ({:.2f})", one.most_um, one.rms_um) : "stopped";
}

const RobustnessPoint& unchanged(const Robustness& found) {
  const auto& points = found.curves.front().points;
  return *std::ranges::find(points, 0.0, &RobustnessPoint::change);
}

Table table_of(const Robustness& found) {
  Table table;
  table.title = "Contour error, µm: largest (RMS)";
  table.caption = fmt::format(
      "Circle of {:g} mm at {:g} mm/s, mean of {} runs. Each column adds one function to the controller left of it; "
      "the machine "
      "changes, "
      "its controller does not.",
      found.options.radius_mm, found.options.feed_mm_s, kSeeds);
  table.headings = {"machine"};
  table.headings.insert(table.headings.end(), kControllers.begin(), kControllers.end());
  const auto add = [&](std::string name, const RobustnessPoint& point) {
    table.rows.push_back({std::move(name)});
    for (const ContourFigures& one : point.by_controller) table.rows.back().push_back(figure_text(one));
  };
  add("as modelled", unchanged(found));
  for (const RobustnessCurve& curve : found.curves)
    for (const RobustnessPoint& point : curve.points)
      if (point.change != 0.0) add(change_text(curve, point.change), point);
  return table;
}

/// Names the change that increases the error of the complete controller most.
Verdict verdict_of(const Robustness& found) {
  const double now = unchanged(found).by_controller.back().most_um;
  double most = -1.0;
  std::string worst;
  for (const RobustnessCurve& curve : found.curves)
    for (const RobustnessPoint& point : curve.points) {
      const ContourFigures& one = point.by_controller.back();
      const double value = one.fault.empty() ? one.most_um : std::numeric_limits<double>::infinity();
      if (point.change == 0.0 || value <= most) continue;
      most = value;
      worst = change_text(curve, point.change);
    }
  Verdict verdict;
  verdict.tone = std::isinf(most) || std::isnan(now) ? Tone::bad : most > 2.0 * now ? Tone::attention : Tone::good;
  verdict.label = std::isinf(most) || std::isnan(now) ? "stops" : most > 2.0 * now ? "sensitive" : "robust";
  verdict.headline = std::isnan(now)    ? "The machine stops with a fault even if it is as modelled."
                     : std::isinf(most) ? fmt::format("With {} the machine stops with a fault.", worst)
                                        : fmt::format(
                                              "With everything on, the contour error is {:.1f} µm, and {:.1f} µm "
                                              "with {}.",
                                              now, most, worst);
  return verdict;
}

ScatterPlot plot_of(const RobustnessCurve& curve, double top_um) {
  constexpr std::array kRoles = {SeriesRole::other, SeriesRole::before, SeriesRole::train, SeriesRole::after};
  ScatterPlot plot;
  plot.title = "Contour error over " + curve.quantity;
  plot.x = {"change of " + curve.quantity, curve.unit};
  plot.y = {"largest contour error", "µm"};
  plot.y_range = {0.0, top_um};
  for (std::size_t i = 0; i < kControllers.size(); ++i) {
    ScatterSeries series;
    series.name = kControllers[i];
    series.role = kRoles[i];
    series.style = SeriesStyle::line_and_points;
    for (const RobustnessPoint& point : curve.points) {
      series.x.push_back(point.change);
      series.y.push_back(point.by_controller[i].most_um);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace

RobustnessAxis robustness_axis(const sim::DriveDescription& drive, const std::string& file) {
  require_volts(drive.data, drive.name, "a board");
  if (drive.data.kind == sim::DriveKind::linear || !(drive.data.encoder_resolution > 0.0))
    throw Failure(ExitCode::bad_input,
                  fmt::format("axis {}: the simulated machine of this command has rotary drives with an encoder: the "
                              "model needs kind = \"rotary\" and [drive.encoder] resolution_mm above 0",
                              drive.name));
  if (file.empty()) return {drive, contouring_parameters(drive, {.friction = true, .cancellation = true})};
  firmware::ParameterValues values;
  put_file(values, file, "x");
  values.set(require_place("x.tachometer.gain"), static_cast<float>(hal::pc::AxisWiring{}.tachometer_resolution));
  return {drive, firmware::axis_parameters<float>(values.axis(0))};
}

Robustness find_robustness(const RobustnessMachine& machine, const RobustnessOptions& options) {
  PathLimits limits{options.feed_mm_s, std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
  for (const RobustnessAxis& axis : machine) {
    limits.acceleration = std::min(limits.acceleration, static_cast<double>(axis.parameters.acceleration_limit));
    limits.jerk = std::min(limits.jerk, static_cast<double>(axis.parameters.jerk_limit));
    if (static_cast<double>(axis.parameters.velocity_limit) < options.feed_mm_s)
      throw Failure(ExitCode::refused, fmt::format("axis {} has a velocity limit of {:g} mm/s: lower --feed",
                                                   axis.drive.name, axis.parameters.velocity_limit));
  }
  Robustness found{options, {}};
  for (const Change& change : changes()) {
    RobustnessCurve curve{change.quantity, change.unit, {}};
    for (const double value : change.values) {
      RobustnessPoint point{value, {}};
      std::array<MachineAxis, hal::kAxisCount> axes;
      for (std::size_t i = 0; i < axes.size(); ++i) {
        axes[i].drive = machine[i].drive;
        if (options.differs[i]) change.apply(axes[i].drive, value);
      }
      for (std::size_t controller = 0; controller < kControllers.size(); ++controller) {
        for (std::size_t i = 0; i < axes.size(); ++i)
          axes[i].parameters = with_controller(machine[i].parameters, controller);
        point.by_controller[controller] = circle(axes, options, limits);
      }
      curve.points.push_back(std::move(point));
    }
    found.curves.push_back(std::move(curve));
  }
  return found;
}

nlohmann::json robustness_json(const Robustness& found) {
  nlohmann::json curves = nlohmann::json::array();
  for (const RobustnessCurve& curve : found.curves) {
    nlohmann::json points = nlohmann::json::array();
    for (const RobustnessPoint& point : curve.points) {
      nlohmann::json by_controller = nlohmann::json::array();
      for (const ContourFigures& one : point.by_controller) {
        if (one.fault.empty())
          by_controller.push_back({{"contour_um", one.most_um}, {"contour_rms_um", one.rms_um}, {"fault", nullptr}});
        else
          by_controller.push_back({{"contour_um", nullptr}, {"contour_rms_um", nullptr}, {"fault", one.fault}});
      }
      points.push_back({{"change", point.change}, {"controllers", by_controller}});
    }
    curves.push_back({{"quantity", curve.quantity}, {"unit", curve.unit}, {"points", points}});
  }
  return {{"format", "axis-robustness/1"},
          {"radius_mm", found.options.radius_mm},
          {"feed_mm_s", found.options.feed_mm_s},
          {"controllers", kControllers},
          {"curves", curves}};
}

std::string robustness_text(const Robustness& found, const Terminal& terminal) {
  return terminal_verdict(verdict_of(found), terminal) + terminal_table(table_of(found), terminal);
}

Report robustness_report(const Robustness& found, const std::string& subtitle) {
  Report report("Robustness", subtitle);
  report.verdict(verdict_of(found));
  report.section("Contour error where the machine differs from its model");
  double top_um = 0.0;
  for (const RobustnessCurve& curve : found.curves)
    for (const RobustnessPoint& point : curve.points)
      for (const ContourFigures& one : point.by_controller)
        if (one.fault.empty()) top_um = std::max(top_um, one.most_um);
  for (const RobustnessCurve& curve : found.curves) report.add(plot_of(curve, 1.05 * top_um));
  report.add(table_of(found));
  return report;
}

}  // namespace host
