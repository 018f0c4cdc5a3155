#include "host/hil/designed_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/exit_codes.hpp"
#include "host/hil/closed_loop.hpp"
#include "host/identify/design_json.hpp"
#include "host/parameters/axis_parameters.hpp"
#include "host/parameters/design_file.hpp"
#include "host/record/drive_units.hpp"
#include "host/report/text_format.hpp"
#include "host/response/response_report.hpp"

namespace host {

namespace {

/// A run of the model with one controller; empty with the reason if the simulated axis faulted.
struct PredictedRun {
  Record record;
  std::string problem;
};

template <typename Motion>
PredictedRun predicted_run(const sim::DriveDescription& model, const firmware::AxisParameters<float>& parameters,
                           Motion motion) {
  constexpr std::uint64_t kSeed = 1;
  try {
    ClosedLoop loop(model, parameters, kSeed);
    motion(loop);
    return {loop.take(), ""};
  } catch (const Failure& failure) {
    return {{}, failure.what()};
  }
}

/// The designed controller last; before it the one that it is compared with, if there is one.
using PredictedRuns = std::vector<PredictedRun>;

std::vector<double> times_of(const PredictedRuns& runs) {
  return std::ranges::max_element(runs, {}, [](const PredictedRun& run) { return run.record.size(); })->record.t_s;
}

/// Position over time of the runs, or if `is_error` reference minus position, in the travel's unit times `factor`.
TracePanel panel_of(const PredictedRuns& runs, const char* quantity, const char* unit, double factor, bool is_error) {
  TracePanel panel{quantity, unit, {}};
  const std::size_t rows = times_of(runs).size();
  for (const PredictedRun& run : runs) {
    const Record& record = run.record;
    if (record.x.empty()) continue;
    const bool is_designed = &run == &runs.back();
    std::vector<double> values(rows, std::nan(""));
    for (std::size_t row = 0; row < record.size(); ++row)
      values[row] = factor * (is_error ? record.x_ref[row] - record.x[row] : record.x[row]);
    panel.traces.push_back(
        {is_designed ? "designed" : "before", is_designed ? SeriesRole::model : SeriesRole::before, std::move(values)});
  }
  return panel;
}

TracePanel commands_of(const PredictedRuns& runs) {
  TracePanel panel = panel_of(runs, "command", "V", 1.0, false);
  std::size_t next = 0;
  for (const PredictedRun& run : runs) {
    if (run.record.x.empty()) continue;
    std::ranges::copy(run.record.u_V, panel.traces[next++].values.begin());
  }
  return panel;
}

double largest_error(const Record& record) {
  double most = 0.0;
  for (std::size_t row = 0; row < record.size(); ++row)
    most = std::max(most, std::abs(record.x_ref[row] - record.x[row]));
  return most;
}

void add_limits(Report& report, const sim::DriveDescription& model, const DriveLimits& limits) {
  const double mm = travel_in_mm(model.data.kind);
  report.section("Limits of the references",
                 fmt::format("They keep the command out of saturation: with them the drive needs {:.3g} V of {:.3g} V. "
                             "What the drive allows leaves {:g} % of its effort in reserve for feedback and cutting.",
                             limits.command_V, limits.limit_V, 100.0 * limits.reserve));
  Table table{
      .title = "", .caption = "", .headings = {"limit", "written", "the drive allows", "unit", "set by"}, .rows = {}};
  const auto add = [&](const char* name, double written, const DriveLimit& drive, const char* unit) {
    table.rows.push_back({name, format_value(mm * written),
                          std::isinf(drive.value) ? "any" : format_value(mm * drive.value), unit, drive.by});
  };
  add("velocity", limits.written.velocity, limits.velocity, "mm/s");
  add("acceleration", limits.written.acceleration, limits.acceleration, "mm/s²");
  add("jerk", limits.written.jerk, limits.jerk, "mm/s³");
  report.add(std::move(table));
}

}  // namespace

DesignedLoop designed_loop(const sim::DriveDescription& model, const DesignOptions& options, const LoopAim& aim,
                           LimitWishes limits, const std::optional<AxisResponse>& response) {
  std::optional<LoopDesign> loop;
  if (response) loop = design_loop(model, options, aim, *response);
  DesignedLoop designed{
      loop ? loop->design : design_axis(model, options), loop ? loop->filters : aim.filters, {}, loop};
  core_filters(designed.filters, model.data.sample_period_s);  // in their ranges
  if (loop && loop->after.margins && !loop->after.margins->is_stable)
    throw Failure(
        ExitCode::refused,
        "the measured drive would oscillate with this controller; nothing was written. --margin 0.5 finds the "
        "highest bandwidth with this modulus margin");
  limits.loop_Hz = designed.design.used.bandwidth_Hz;
  if (loop && loop->after.fit) limits.measured_Hz = lowest_resonance_Hz(*loop->after.fit);
  designed.limits = drive_limits(model, limits);
  return designed;
}

nlohmann::json designed_loop_json(const DesignedLoop& designed) {
  nlohmann::json document = design_json(designed.design);
  document["filters"] = filter_json(designed.filters);
  document["limits"] = drive_limits_json(designed.limits);
  if (designed.loop) {
    document["before"] = response_json(designed.loop->before)["margins"];
    document["after"] = response_json(designed.loop->after)["margins"];
  }
  return document;
}

void add_predicted_motion(Report& report, const sim::DriveDescription& model, const DesignedLoop& designed,
                          const DesignOptions& options) {
  std::vector<firmware::AxisParameters<float>> controllers;
  const ReferenceLimits& limits = designed.limits.written;
  if (designed.loop || designed.filters.notch || designed.filters.low_pass)
    controllers.push_back(designed_parameters(model, design_axis(model, options), {}, limits));
  controllers.push_back(designed_parameters(model, designed.design, designed.filters, limits));
  // A tenth of the command's range by the feedback alone, and a move that reaches its speed for a tenth of a second.
  const double step = 0.1 * model.data.dac_limit_V / std::max(std::abs(designed.design.Kc(0)), 1e-9);
  const double v = limits.velocity, a = limits.acceleration, j = limits.jerk;
  const double travel = v * (v / a + a / j + 0.1);
  PredictedRuns steps, moves;
  for (const auto& controller : controllers) {
    steps.push_back(predicted_run(model, controller, [&](ClosedLoop& loop) {
      loop.run(0.02);
      loop.step_reference(step);
      loop.run(0.2);
    }));
    moves.push_back(predicted_run(model, controller, [&](ClosedLoop& loop) {
      loop.run(0.05);
      loop.start_move_to(travel);
      loop.run_until_at_rest();
      loop.run(0.1);
    }));
  }
  const DriveUnits units = units_of(model.data.kind);
  const double um = 1e3 * travel_in_mm(model.data.kind);
  report.section("Predicted motion", "The model in closed loop with the board's own controller, noise included.");
  Facts facts;
  for (const PredictedRun& move : moves)
    facts.items.emplace_back(
        &move == &moves.back() ? "largest following error, designed" : "largest following error before",
        move.problem.empty() ? format_value(um * largest_error(move.record)) + " µm" : move.problem);
  report.add(std::move(facts));
  const auto add = [&](const std::string& title, const PredictedRuns& runs, bool is_move) {
    TimePlot plot;
    plot.title = title;
    plot.t_s = times_of(runs);
    if (plot.t_s.empty()) return;
    plot.panels.push_back(is_move ? panel_of(runs, "following error", "µm", um, true)
                                  : panel_of(runs, "position", units.travel, 1.0, false));
    plot.panels.push_back(commands_of(runs));
    report.add(std::move(plot));
  };
  add(fmt::format("Step of {:.3g} {}", step, units.travel), steps, false);
  add(fmt::format("Move over {:.3g} {} at the limits of speed, acceleration and jerk", travel, units.travel), moves,
      true);
}

Report designed_loop_report(const sim::DriveDescription& model, const DesignedLoop& designed,
                            const DesignOptions& options) {
  const std::string title = "axis " + model.name + ", designed";
  Report report = designed.loop ? response_report(designed.loop->after, title, &designed.loop->before)
                                : Report("Controller", title);
  add_limits(report, model, designed.limits);
  add_predicted_motion(report, model, designed, options);
  return report;
}

}  // namespace host
