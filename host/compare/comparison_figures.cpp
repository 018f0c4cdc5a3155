#include "host/compare/comparison_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <utility>

#include "host/compare/residual_figures.hpp"
#include "host/evidence/measured_sensors.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/record/drive_units.hpp"
#include "host/record/record_origin.hpp"

namespace host {

ComparedModel compare_with(const std::string& path, const sim::DriveDescription& model, std::vector<Record> records,
                           double window_s, const std::vector<std::string>& accepted) {
  if (!(window_s > 0.0) || !std::isfinite(window_s))
    throw Failure(ExitCode::usage, fmt::format("window {}: a length in seconds above 0 belongs here", window_s));
  Measurements measured = MeasurementGate(model, {.accepted = accepted, .as_logged = true}).admit(std::move(records));
  sim::DriveDescription completed = with_measured_sensors(model, measured);
  std::vector<FigureRecord> counted;
  for (const Record* record : measured.training_records()) counted.push_back({record});
  RecordSet set = figure_set(model, counted, window_s);
  ModelComparison comparison = compare_model(completed, measured, set);
  return {path, std::move(completed), std::move(measured), std::move(set), std::move(comparison)};
}

nlohmann::json comparison_document(std::span<const ComparedModel> models) {
  nlohmann::json document = comparison_json(models.front().comparison);
  document["model"] = models.front().path;
  document["effort_timing"] = effort_timing_json(models.front().measured.training_records());
  if (models.size() == 1) return document;
  for (const ComparedModel& one : models) {
    nlohmann::json part = comparison_json(one.comparison);
    part.erase("format");
    part["model"] = one.path;
    document["models"].push_back(std::move(part));
  }
  return document;
}

SeriesRole role_of_model(std::size_t index) {
  constexpr std::array roles{SeriesRole::predicted, SeriesRole::model, SeriesRole::other, SeriesRole::residual,
                             SeriesRole::train};
  return roles[index % roles.size()];
}

std::string ComparedModel::name() const { return std::filesystem::path(path).filename().string(); }

TimePlot prediction_traces(std::span<const ComparedModel> models, std::size_t record_index) {
  const ComparedRecord& compared = models.front().set.records[record_index];
  const PreparedRecord& prepared = compared.prepared;
  const Record& record = *prepared.record;
  const DriveUnits units = units_of(record.kind);
  std::vector<Prediction> predictions;
  for (const ComparedModel& one : models)
    predictions.push_back(predict_all_rows(one.model, one.set.records[record_index].prepared));
  TimePlot plot;
  plot.title = "Measured and predicted: " + file_name(record);
  plot.caption =
      "The prediction restarts from the measurement at every window; error that grows within a window is model error.";
  plot.t_s = record.t_s;
  const auto floor_of = [&](const std::vector<double>& floors, double sign) {
    std::vector<double> rows(record.size(), std::nan(""));
    for (std::size_t w = 0; w < std::min(floors.size(), prepared.windows.size()); ++w)
      for (std::size_t k = 1; k <= prepared.windows[w].length; ++k)
        rows[prepared.windows[w].begin + k] = sign * floors[w];
    return rows;
  };
  const auto add = [&](const char* quantity, const char* unit, const std::vector<double>& measured,
                       std::vector<double> Prediction::*channel, const std::vector<double>& floors) {
    TracePanel traces{quantity, unit, {{"measured", SeriesRole::measured, measured}}};
    TracePanel errors{std::string(quantity) + " error", unit, {}};
    for (std::size_t m = 0; m < models.size(); ++m) {
      const std::vector<double>& predicted = predictions[m].*channel;
      if (predicted.size() != measured.size()) continue;
      std::vector<double> error(measured.size());
      std::ranges::transform(predicted, measured, error.begin(), std::minus<>());
      const bool alone = models.size() == 1;
      traces.traces.push_back({alone ? "predicted" : models[m].name(), role_of_model(m), predicted});
      errors.traces.push_back(
          {alone ? "error" : models[m].name(), alone ? SeriesRole::residual : role_of_model(m), error});
    }
    errors.traces.push_back({"noise floor", SeriesRole::floor, floor_of(floors, 1.0)});
    errors.traces.push_back({"−noise floor", SeriesRole::floor, floor_of(floors, -1.0)});
    plot.panels.push_back(std::move(traces));
    plot.panels.push_back(std::move(errors));
  };
  if (record.has_speed()) add("speed", units.speed, record.w, &Prediction::w, compared.floor.w);
  if (record.has_position()) add("position", units.travel, record.x, &Prediction::x, compared.floor.x);
  plot.panels.push_back({"command", "V", {{"command", SeriesRole::other, prepared.u_V}}});
  return plot;
}

void add_missing_effort(std::span<const ComparedModel> models, Report& report) {
  const sim::DriveDescription& first = models.front().model;
  std::vector<const sim::DriveDescription*> descriptions;
  for (const ComparedModel& one : models) descriptions.push_back(&one.model);
  std::vector<ResidualEffort> residuals = residuals_on(descriptions, models.front().set);
  std::vector<ResidualView> views;
  for (std::size_t m = 0; m < models.size(); ++m)
    views.push_back({models[m].name(), role_of_model(m), std::move(residuals[m]),
                     residual_of_speed_channel(models[m].model, models[m].set)});
  if (views.front().force.w.empty()) return;
  const std::string effort = first.data.kind == sim::DriveKind::rotary ? "torque" : "force";
  const double period = ripple_period(first);
  report.section(
      "What is missing, as " + effort,
      fmt::format("The {} that the motion needed beyond the model's: mean in bins{}, forward and backward apart. A "
                  "missing effect shows as a curve against the coordinate that it depends on. Where there are no "
                  "samples the line breaks; the strip at the foot shows how many there are.",
                  effort, models.size() == 1 ? " with the band that holds 80 % of the samples" : ""));
  add_residual_plots(report, views, first, period, Layout::overlaid);
  const DriveUnits units = units_of(first.data.kind);
  for (const auto& [name, title] :
       {std::pair("travel_since_reversal", "After a reversal"), std::pair("rest", "After a rest"),
        std::pair("current", "Against the command"), std::pair("temperature", "Against temperature")}) {
    const ResidualCoordinate over = coordinate_of(name, first.data.kind);
    if ((views.front().force.*over.along).empty()) continue;
    add_residual_plot(report, over, title, {"missing " + effort, units.effort}, views, &ResidualView::force,
                      Layout::overlaid);
  }
  if (models.size() == 1) add_residual_maps(report, views, first, period);
}

}  // namespace host
