#include "host/hil/scenario_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/hil/circle_plot.hpp"
#include "host/hil/identification_figures.hpp"
#include "host/identify/friction_law.hpp"
#include "host/report/text_format.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

std::string seconds(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : std::string("–");
}

Table expectation_table(const ScenarioRun& run) {
  Table table;
  table.title = "Expectations";
  table.headings = {"what must hold", "found", ""};
  for (const CheckedExpectation& checked : run.expectations)
    table.rows.push_back({checked.aim ? "aim: " + checked.text : checked.text, checked.found,
                          checked.holds ? "holds"
                          : checked.aim ? "missed"
                                        : "FAILS"});
  return table;
}

Table stop_table(const ScenarioRun& run) {
  Table table;
  table.title = "Faults and stops";
  table.caption = "Reaction: from the injection to the fault. Stop: from the fault until the axis stands, outputs off.";
  table.headings = {"at, s", "axis", "fault", "reaction, s", "stop, s", "distance, mm", "cause"};
  for (const StopEvent& stop : run.stops) {
    const auto& info = firmware::fault_info(stop.fault);
    table.rows.push_back({fmt::format("{:.3f}", stop.at_s), std::string(kAxisNames[stop.axis]), info.name,
                          seconds(stop.reaction_s), seconds(stop.standing_s), fmt::format("{:.3f}", stop.distance_mm),
                          info.cause});
  }
  return table;
}

/// Tracking errors of both axes and contour error, as in the paper's Fig. 11.
TimePlot error_plot(const ScenarioRun& run) {
  TimePlot plot;
  plot.title = run.contour_um.empty() ? "Tracking errors" : "Tracking and contour errors (as Fig. 11)";
  plot.caption = "Reference minus encoder.";
  plot.t_s = run.records[0].t_s;
  for (std::size_t i = 0; i < hal::kAxisCount; ++i)
    plot.panels.push_back(
        {fmt::format("axis {}", kAxisNames[i]), "µm", {{"tracking error", SeriesRole::residual, run.tracking_um[i]}}});
  if (!run.contour_um.empty())
    plot.panels.push_back({"contour error", "µm", {{"contour error", SeriesRole::before, run.contour_um}}});
  for (const StopEvent& stop : run.stops)
    plot.shaded.push_back({stop.at_s, stop.at_s + stop.standing_s.value_or(0.05)});
  return plot;
}

/// Speed, command and the disturbance estimated by the Kalman filter, as in the paper's Fig. 9.
TimePlot motion_plot(const ScenarioRun& run, std::size_t axis) {
  const Record& record = run.records[axis];
  TimePlot plot;
  plot.title = fmt::format("Axis {}: motion and disturbance (as Fig. 9)", kAxisNames[axis]);
  plot.caption = "The Kalman filter's disturbance is the friction that feed-forward does not cancel.";
  plot.t_s = record.t_s;
  plot.panels = {
      {"position", "mm", {{"encoder", SeriesRole::measured, record.x}, {"reference", SeriesRole::model, record.x_ref}}},
      {"speed", "rad/s", {{"reference", SeriesRole::model, record.w_ref}}},
      {"command",
       "V",
       {{"D/A converter", SeriesRole::other, record.u_V},
        {"disturbance", SeriesRole::residual, run.disturbance_V[axis]}}}};
  if (record.has_speed())
    plot.panels[1].traces.insert(plot.panels[1].traces.begin(), {"tachometer", SeriesRole::measured, record.w});
  return plot;
}

/// The path of the encoders, and its deviation.
ScatterPlot plane_plot(const ScenarioRun& run) {
  ScatterPlot plot;
  plot.title = "The path in the plane";
  plot.equal_scales = true;
  plot.x = {"x", "mm"};
  plot.y = {"y", "mm"};
  const auto every = [](const std::vector<double>& values) {
    std::vector<double> some;
    for (std::size_t k = 0; k < values.size(); k += 4) some.push_back(values[k]);
    return some;
  };
  plot.series = {{"reference",
                  SeriesRole::model,
                  SeriesStyle::points,
                  every(run.records[0].x_ref),
                  every(run.records[1].x_ref),
                  {},
                  {}},
                 {"encoders",
                  SeriesRole::measured,
                  SeriesStyle::points,
                  every(run.records[0].x),
                  every(run.records[1].x),
                  {},
                  {}}};
  return plot;
}

/// The controller's friction curve and the drive's true friction, as in the paper's Fig. 10.
ScatterPlot friction_plot(const Scenario& scenario, const ScenarioRun& run, std::size_t axis) {
  ScatterPlot plot;
  plot.title = fmt::format("Axis {}: friction curve (as Fig. 10)", kAxisNames[axis]);
  plot.x = {"speed", "rad/s"};
  plot.y = {"friction torque", "Nm"};
  const auto curve = [](const FrictionLaw& law, const char* name, SeriesRole role) {
    ScatterSeries series{name, role, SeriesStyle::line, {}, {}, {}, {}};
    for (int step = -200; step <= 200; ++step) {
      const double part = step / 200.0;
      const double speed = 63.0 * part * std::abs(part);  // closer together where the curve bends
      series.x.push_back(speed);
      series.y.push_back(step == 0 ? std::nan("") : law.effort(speed));
    }
    return series;
  };
  plot.series = {curve(friction_law(scenario.axes[axis].drive), "the drive's", SeriesRole::other),
                 curve(friction_law(run.believed[axis]), "identified", SeriesRole::model)};
  return plot;
}

Verdict verdict_of(const Scenario& scenario, const ScenarioRun& run) {
  Verdict verdict;
  const ScenarioOutcome outcome = outcome_of(run);
  verdict.tone = outcome.tone;
  verdict.label = outcome.word;
  verdict.headline = summary_of(run);
  if (!scenario.about.empty()) verdict.sentences.push_back(scenario.about);
  for (const StopEvent& stop : run.stops)
    verdict.sentences.push_back(fmt::format("Axis {} stopped at {:.3f} s: {}.", kAxisNames[stop.axis], stop.at_s,
                                            firmware::fault_info(stop.fault).cause));
  return verdict;
}

Facts figures(const Scenario& scenario, const ScenarioRun& run) {
  Facts facts;
  facts.title = "Figures";
  facts.items = {
      {"simulated", fmt::format("{:g} s", run.simulated_s)},
      {"seed", fmt::format("{}", scenario.seed)},
      {"largest tracking error", fmt::format("x {} µm, y {} µm", format_value(largest_magnitude(run.tracking_um[0]), 3),
                                             format_value(largest_magnitude(run.tracking_um[1]), 3))}};
  if (!run.contour_um.empty())
    facts.items.emplace_back("largest contour error", format_value(largest_magnitude(run.contour_um), 3) + " µm");
  return facts;
}

}  // namespace

ScenarioOutcome outcome_of(const ScenarioRun& run) {
  if (!run.holds()) return {Tone::bad, "FAILS"};
  if (run.misses_aim()) return {Tone::attention, "misses its target"};
  return {Tone::good, run.expectations.empty() ? "ran" : "holds"};
}

std::string summary_of(const ScenarioRun& run) {
  std::string text;
  if (!run.contour_um.empty())
    text = fmt::format("contour error up to {} µm", format_value(largest_magnitude(run.contour_um)));
  else
    text = fmt::format("tracking error up to {} µm", format_value(std::max(largest_magnitude(run.tracking_um[0]),
                                                                           largest_magnitude(run.tracking_um[1]))));
  for (const StopEvent& stop : run.stops)
    text += fmt::format(", axis {} stopped by {}", kAxisNames[stop.axis], firmware::fault_info(stop.fault).name);
  const auto held = std::ranges::count_if(run.expectations, &CheckedExpectation::holds);
  if (!run.expectations.empty()) text += fmt::format("; {} of {} expectations hold", held, run.expectations.size());
  return capitalised(text);
}

Report scenario_report(const Scenario& scenario, const ScenarioRun& run) {
  Report report(scenario.name, scenario.path);
  report.verdict(verdict_of(scenario, run));
  report.section("What was expected, and what happened");
  if (!run.expectations.empty()) report.add(expectation_table(run));
  if (!run.stops.empty()) report.add(stop_table(run));
  report.add(figures(scenario, run));
  report.add(error_plot(run));
  if (!run.contour_um.empty()) report.add(plane_plot(run));
  if (auto circle = circle_plot(scenario, {{"encoders", SeriesRole::before, &run}})) report.add(std::move(*circle));
  report.section("Each axis");
  for (std::size_t i = 0; i < hal::kAxisCount; ++i) {
    report.add(motion_plot(run, i));
    if (scenario.axes[i].knowledge != Knowledge::identified) continue;
    add_identification_figures(scenario.axes[i].drive, kAxisNames[i], commissioning_seed(scenario, i), report);
    report.add(friction_plot(scenario, run, i));
  }
  return report;
}

nlohmann::json scenario_json(const Scenario& scenario, const ScenarioRun& run) {
  nlohmann::json document = {
      {"format", "axis-hil/1"}, {"scenario", scenario.path},      {"name", scenario.name},
      {"seed", scenario.seed},  {"simulated_s", run.simulated_s}, {"times_real_time", run.times_real_time()},
      {"holds", run.holds()}};
  for (std::size_t i = 0; i < hal::kAxisCount; ++i)
    document["axes"][std::string(kAxisNames[i])] = {{"tracking_um", largest_magnitude(run.tracking_um[i])},
                                                    {"following_high_water_um", run.high_water_um[i]}};
  if (!run.contour_um.empty()) document["contour_um"] = largest_magnitude(run.contour_um);
  document["expectations"] = nlohmann::json::array();
  for (const CheckedExpectation& checked : run.expectations)
    document["expectations"].push_back(
        {{"what", checked.text}, {"found", checked.found}, {"holds", checked.holds}, {"aim", checked.aim}});
  document["stops"] = nlohmann::json::array();
  const auto optional = [](const std::optional<double>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
  };
  for (const StopEvent& stop : run.stops) {
    const auto& info = firmware::fault_info(stop.fault);
    document["stops"].push_back({{"axis", kAxisNames[stop.axis]},
                                 {"fault", info.name},
                                 {"number", static_cast<int>(stop.fault)},
                                 {"cause", info.cause},
                                 {"remedy", info.remedy},
                                 {"at_s", stop.at_s},
                                 {"reaction_s", optional(stop.reaction_s)},
                                 {"standing_s", optional(stop.standing_s)},
                                 {"distance_mm", stop.distance_mm}});
  }
  return document;
}

std::string scenario_text(const Scenario& scenario, const ScenarioRun& run, const Terminal& terminal) {
  std::string text =
      fmt::format("{}: {:g} s simulated, {:.0f} × real time\n", scenario.name, run.simulated_s, run.times_real_time());
  if (!run.stops.empty()) text += terminal_table(stop_table(run), terminal) + "\n";
  if (!run.expectations.empty()) text += terminal_table(expectation_table(run), terminal) + "\n";
  for (const auto& [what, value] : figures(scenario, run).items) text += fmt::format("{}: {}\n", what, value);
  return text;
}

}  // namespace host
