#include "host/hil/designed_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

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

/// Position over time of the runs, or if `is_error` reference minus position, in the travel's unit times `factor`.
TracePanel panel_of(const std::array<PredictedRun, 2>& runs, const char* quantity, const char* unit, double factor,
                    bool is_error) {
  constexpr std::array kNames{"before", "designed"};
  constexpr std::array kRoles{SeriesRole::before, SeriesRole::model};
  TracePanel panel{quantity, unit, {}};
  const std::size_t rows = std::max(runs[0].record.size(), runs[1].record.size());
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Record& record = runs[k].record;
    if (record.x.empty()) continue;
    std::vector<double> values(rows, std::nan(""));
    for (std::size_t row = 0; row < record.size(); ++row)
      values[row] = factor * (is_error ? record.x_ref[row] - record.x[row] : record.x[row]);
    panel.traces.push_back({kNames[k], kRoles[k], std::move(values)});
  }
  return panel;
}

TracePanel commands_of(const std::array<PredictedRun, 2>& runs) {
  TracePanel panel = panel_of(runs, "command", "V", 1.0, false);
  std::size_t next = 0;
  for (const PredictedRun& run : runs) {
    if (run.record.x.empty()) continue;
    std::ranges::copy(run.record.u_V, panel.traces[next++].values.begin());
  }
  return panel;
}

std::vector<double> times_of(const std::array<PredictedRun, 2>& runs) {
  return runs[0].record.size() > runs[1].record.size() ? runs[0].record.t_s : runs[1].record.t_s;
}

double largest_error(const Record& record) {
  double most = 0.0;
  for (std::size_t row = 0; row < record.size(); ++row)
    most = std::max(most, std::abs(record.x_ref[row] - record.x[row]));
  return most;
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
  const auto controller = [&](const AxisDesign& design, const ControlFilterChoice& filters) {
    return designed_parameters(model, design, filters);
  };
  const std::array controllers{controller(design_axis(model, options), {}),
                               controller(designed.design, designed.filters)};
  // A tenth of the command's range by the feedback alone, and a move that reaches its speed for a tenth of a second.
  const double step = 0.1 * model.data.dac_limit_V / std::max(std::abs(designed.design.Kc(0)), 1e-9);
  const ReferenceLimits limits = ReferenceLimits::usual_for(model.data.kind);
  const double v = limits.velocity, a = limits.acceleration, j = limits.jerk;
  const double travel = v * (v / a + a / j + 0.1);
  std::array<PredictedRun, 2> steps, moves;
  for (std::size_t k = 0; k < controllers.size(); ++k) {
    steps[k] = predicted_run(model, controllers[k], [&](ClosedLoop& loop) {
      loop.run(0.02);
      loop.step_reference(step);
      loop.run(0.2);
    });
    moves[k] = predicted_run(model, controllers[k], [&](ClosedLoop& loop) {
      loop.run(0.05);
      loop.start_move_to(travel);
      loop.run_until_at_rest();
      loop.run(0.1);
    });
  }
  const DriveUnits units = units_of(model.data.kind);
  const double um = 1e3 * travel_in_mm(model.data.kind);
  report.section("Predicted motion", "The model in closed loop with the board's own controller, noise included.");
  Facts facts;
  for (std::size_t k = 0; k < moves.size(); ++k)
    facts.items.emplace_back(
        k == 0 ? "largest following error before" : "largest following error, designed",
        moves[k].problem.empty() ? format_value(um * largest_error(moves[k].record)) + " µm" : moves[k].problem);
  report.add(std::move(facts));
  const auto add = [&](const std::string& title, const std::array<PredictedRun, 2>& runs, bool is_move) {
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
  add_predicted_motion(report, model, designed, options);
  return report;
}

}  // namespace host
