#include "host/compare/comparison_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <utility>

#include "host/cancellation.hpp"
#include "host/compare/residual_figures.hpp"
#include "host/compare/residual_spectrum.hpp"
#include "host/evidence/measured_sensors.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/identify/force_estimate.hpp"
#include "host/record/drive_units.hpp"
#include "host/record/record_origin.hpp"

namespace host {

ComparedModel compare_with(const std::string& path, const sim::DriveDescription& model, std::vector<Record> records,
                           double window_s, const std::vector<std::string>& accepted, const ShareDone& progress) {
  if (!(window_s > 0.0) || !std::isfinite(window_s))
    throw Failure(ExitCode::usage, fmt::format("window {}: expected a length in seconds above 0", window_s));
  Measurements measured = MeasurementGate(model, {.accepted = accepted, .as_logged = true}).admit(std::move(records));
  sim::DriveDescription completed = with_measured_sensors(model, measured);
  std::vector<FigureRecord> counted;
  for (const Record* record : measured.training_records()) counted.push_back({record});
  // Shares of the time of a record of ten million rows.
  constexpr double kAdmitted = 0.3, kPrepared = 0.6;
  const auto is_done = [&](double share) {
    throw_if_cancelled();
    if (progress) progress(share);
  };
  is_done(kAdmitted);
  RecordSet set = figure_set(model, counted, window_s);
  is_done(kPrepared);
  ModelComparison comparison = compare_model(completed, measured, set);
  is_done(1.0);
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

std::size_t record_in(const Focus& focus, const ModelComparison& comparison) {
  const auto& records = comparison.records;
  const auto found = focus.record.empty() ? std::ranges::max_element(
                                                records, {}, [](const RecordError& one) { return one.error.combined; })
                                          : std::ranges::find(records, focus.record, &RecordError::path);
  if (found == records.end()) throw Failure(ExitCode::usage, focus.record + ": not one of the compared records");
  return static_cast<std::size_t>(found - records.begin());
}

namespace {

/// The samples within a time range of one record.
ResidualEffort part_in(const ResidualEffort& all, std::size_t record, const TimeSpan& since_start) {
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < all.w.size(); ++k)
    if (all.record[k] == record && all.t_s[k] >= since_start.from_s && all.t_s[k] <= since_start.to_s)
      kept.push_back(k);
  ResidualEffort part = all;
  const auto keep = [&](auto& values) {
    if (values.size() != all.w.size()) return;
    for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
    values.resize(kept.size());
  };
  for (const auto indices : {&ResidualEffort::record, &ResidualEffort::slot, &ResidualEffort::window})
    keep(part.*indices);
  for (const auto values : {&ResidualEffort::missing, &ResidualEffort::t_s, &ResidualEffort::x,
                            &ResidualEffort::acceleration, &ResidualEffort::command_V, &ResidualEffort::since_reversal,
                            &ResidualEffort::rest_s, &ResidualEffort::temp_C, &ResidualEffort::w})
    keep(part.*values);
  return part;
}

/// Whether the coordinate has different values; a single rest gives no curve.
bool spreads(const std::vector<double>& coordinate) {
  if (coordinate.empty()) return false;
  const auto [least, most] = std::ranges::minmax(coordinate);
  return most - least > 0.1 * std::max(std::abs(least), std::abs(most));
}

/// Adds the first model's residual in the selected interval, if it has samples there.
void add_stretch(std::vector<ResidualView>& views, const ComparedModel& model, const Focus& focus) {
  if (!focus.stretch) return;
  const std::size_t index = record_in(focus, model.comparison);
  const double start_s = model.set.records[index].prepared.record->t_s.front();
  const TimeSpan since_start{focus.stretch->from_s - start_s, focus.stretch->to_s - start_s};
  ResidualView lit{fmt::format("{:.3g} to {:.3g} s", focus.stretch->from_s, focus.stretch->to_s), SeriesRole::residual,
                   part_in(views.front().force, index, since_start), part_in(views.front().speed, index, since_start)};
  if (!lit.force.w.empty()) views.push_back(std::move(lit));
}

/// The board's estimate of the process force, where the record holds it, with its 95 % band.
void add_process_force(const Record& record, TimePlot& plot) {
  const auto force = std::ranges::find(record.extra, kProcessForce, &ExtraChannel::name);
  if (force == record.extra.end()) return;
  TracePanel panel{"process force", "N", {{"estimated", SeriesRole::measured, force->values}}};
  const auto band = record.header.find(kProcessForceBand);
  const double half_N = band == record.header.end() ? 0.0 : std::strtod(band->second.c_str(), nullptr);
  for (const double side : {1.0, -1.0}) {
    if (!(half_N > 0.0)) break;
    std::vector<double> edge = force->values;
    for (double& value : edge) value += side * half_N;
    panel.traces.push_back({side > 0.0 ? "+95 % band" : "−95 % band", SeriesRole::floor, std::move(edge)});
  }
  plot.panels.push_back(std::move(panel));
}

}  // namespace

TimePlot prediction_traces(std::span<const ComparedModel> models, std::size_t record_index,
                           const std::optional<TimeSpan>& stretch) {
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
  if (stretch) plot.shaded.push_back(*stretch);
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
  add_process_force(record, plot);
  return plot;
}

void add_missing_effort(std::span<const ComparedModel> models, Report& report, const Focus& focus) {
  const sim::DriveDescription& first = models.front().model;
  std::vector<const sim::DriveDescription*> descriptions;
  for (const ComparedModel& one : models) descriptions.push_back(&one.model);
  std::vector<ResidualEffort> residuals = residuals_on(descriptions, models.front().set);
  std::vector<ResidualView> views;
  for (std::size_t m = 0; m < models.size(); ++m)
    views.push_back({models[m].name(), role_of_model(m), std::move(residuals[m]),
                     residual_of_speed_channel(models[m].model, models[m].set)});
  if (views.front().force.w.empty()) return;
  add_stretch(views, models.front(), focus);
  const std::string effort = first.data.kind == sim::DriveKind::rotary ? "torque" : "force";
  const double period = focus.period_mm ? *focus.period_mm / travel_in_mm(first.data.kind) : ripple_period(first);
  report.section("What is missing, as " + effort,
                 fmt::format("Residual {}, measured minus model: mean in bins{}, forward and backward separately. A "
                             "missing effect shows as a curve over its coordinate. The line breaks where there are no "
                             "samples; the strip below shows their number.",
                             effort, views.size() == 1 ? " with the band that holds 80 % of the samples" : ""));
  if (focus.plot) add_chosen_plot(report, views, *focus.plot, first.data.kind, period);
  add_residual_plots(report, views, first, period, Layout::overlaid);
  const DriveUnits units = units_of(first.data.kind);
  for (const auto& [name, title] :
       {std::pair("travel_since_reversal", "After a reversal"), std::pair("rest", "After a rest"),
        std::pair("current", "Against the command"), std::pair("temperature", "Against temperature")}) {
    const ResidualCoordinate over = coordinate_of(name, first.data.kind);
    if (!spreads(views.front().force.*over.along)) continue;
    add_residual_plot(report, over, title, {"missing " + effort, units.effort}, views, &ResidualView::force,
                      Layout::overlaid);
  }
  add_residual_spectrum(report, views, first.data.kind);
  const auto [across, up] = focus.map.value_or(std::pair<std::string, std::string>("position", "speed"));
  if (models.size() == 1 || focus.map)
    add_residual_maps(report, std::span(views).first(models.size()), coordinate_of(across, first.data.kind, period),
                      coordinate_of(up, first.data.kind), first.data.kind);
}

}  // namespace host
