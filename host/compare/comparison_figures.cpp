#include "host/compare/comparison_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <utility>

#include "host/compare/effort_residual.hpp"
#include "host/evidence/measured_sensors.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/exit_codes.hpp"
#include "host/record/drive_units.hpp"
#include "host/record/record_origin.hpp"
#include "host/report/binned_curve.hpp"

namespace host {

namespace {

constexpr std::size_t kBins = 60;
constexpr std::size_t kStride = 2;
constexpr std::size_t kFewestSamples = 20;  // a mean of fewer tells of their noise

ScatterSeries curve_of(const std::string& name, SeriesRole role, const std::vector<double>& x,
                       const std::vector<double>& y) {
  return curve_series(name, role, binned_curve(x, y, kBins, kFewestSamples));
}

/// One coordinate's values of each model's samples, and of what is drawn over it.
using Channel = std::vector<double> ResidualSamples::*;

ScatterPlot against(const std::string& title, Axis coordinate, Axis value, std::span<const ComparedModel> models,
                    std::span<const ResidualSamples> samples, Channel along, Channel what) {
  ScatterPlot plot;
  plot.title = title;
  plot.x = std::move(coordinate);
  plot.y = std::move(value);
  const auto add = [&plot](ScatterSeries series) {
    if (!series.x.empty()) plot.series.push_back(std::move(series));
  };
  if (models.size() > 1) {
    for (std::size_t m = 0; m < models.size(); ++m)
      add(curve_of(models[m].name(), role_of_model(m), samples[m].*along, samples[m].*what));
    return plot;
  }
  const ResidualSamples& all = samples.front();
  for (const double sign : {1.0, -1.0}) {
    std::vector<double> x, y;
    for (std::size_t k = 0; k < all.w.size(); ++k) {
      if (all.w[k] * sign <= 0.0) continue;
      x.push_back((all.*along)[k]);
      y.push_back((all.*what)[k]);
    }
    add(curve_of(sign > 0.0 ? "forward" : "backward", sign > 0.0 ? SeriesRole::residual : SeriesRole::other, x, y));
  }
  return plot;
}

}  // namespace

ComparedModel compare_with(const std::string& path, const sim::DriveDescription& model, std::vector<Record> records,
                           double window_s, const std::vector<std::string>& accepted) {
  if (!(window_s > 0.0) || !std::isfinite(window_s))
    throw Failure(ExitCode::usage, fmt::format("window {}: a length in seconds above 0 belongs here", window_s));
  Measurements measured = MeasurementGate(model, {.accepted = accepted, .as_logged = true}).admit(std::move(records));
  sim::DriveDescription completed = with_measured_sensors(model, measured);
  RecordSet set = compare_on(measured.training_records(), completed, window_s);
  ModelComparison comparison = compare_model(completed, measured, set, window_s);
  return {path, std::move(completed), std::move(measured), std::move(set), std::move(comparison)};
}

SeriesRole role_of_model(std::size_t index) {
  constexpr std::array roles{SeriesRole::predicted, SeriesRole::model, SeriesRole::other, SeriesRole::residual,
                             SeriesRole::train};
  return roles[index % roles.size()];
}

std::string ComparedModel::name() const { return std::filesystem::path(path).filename().string(); }

TimePlot prediction_traces(std::span<const ComparedModel> models, std::size_t record_index) {
  const PreparedRecord& prepared = models.front().set.records[record_index].prepared;
  const Record& record = *prepared.record;
  const DriveUnits units = units_of(record.kind);
  std::vector<Prediction> predictions;
  for (const ComparedModel& one : models)
    predictions.push_back(predict_all_rows(one.model, one.set.records[record_index].prepared));
  TimePlot plot;
  plot.title = "Measured and predicted: " + file_name(record);
  plot.caption = "Predictions restart at every window: what grows from there to the next one is what a model lacks.";
  plot.t_s = record.t_s;
  const auto add = [&](const char* quantity, const char* unit, const std::vector<double>& measured,
                       std::vector<double> Prediction::*channel) {
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
    plot.panels.push_back(std::move(traces));
    plot.panels.push_back(std::move(errors));
  };
  if (record.has_speed()) add("speed", units.speed, record.w, &Prediction::w);
  if (record.has_position()) add("position", units.travel, record.x, &Prediction::x);
  plot.panels.push_back({"command", "V", {{"command", SeriesRole::other, prepared.u_V}}});
  return plot;
}

void add_missing_effort(std::span<const ComparedModel> models, Report& report) {
  std::vector<ResidualSamples> samples;
  for (const ComparedModel& one : models) samples.push_back(residual_samples(one.model, one.set, kStride));
  const ResidualSamples& first = samples.front();
  if (first.w.empty()) return;
  const bool rotary = models.front().model.data.kind == sim::DriveKind::rotary;
  const bool has_position = models.front().set.records.front().prepared.record->has_position();
  const DriveUnits units = units_of(models.front().model.data.kind);
  const Axis missing{rotary ? "missing torque" : "missing force", units.effort};
  const std::string effort = rotary ? "torque" : "force";
  const Axis speed{"speed", units.speed}, acceleration{"acceleration", units.acceleration};
  report.section(
      "What is missing, as " + effort,
      "The " + effort +
          " that the motion needed beyond what the model explains: mean in bins with the band "
          "that holds 80 % of the samples" +
          (models.size() == 1 ? ", by direction" : "") +
          ". A missing effect shows as a curve against the coordinate that it depends on. Where there are no "
          "samples the line breaks; the strip at the foot shows how many there are.");
  const auto add = [&](const char* name, Axis axis, Channel along) {
    report.add(against(fmt::format("Against {}", name), std::move(axis), missing, models, samples, along,
                       &ResidualSamples::missing));
  };
  add("speed", speed, &ResidualSamples::w);
  if (has_position) add("position", {"position", units.travel}, &ResidualSamples::x);
  add("acceleration", acceleration, &ResidualSamples::acceleration);
  add("time", {"time", "s"}, &ResidualSamples::t_s);
  if (first.tach_error.size() != first.w.size() || !has_position) return;
  report.section("What the tachometer adds",
                 "Tachometer less what the model's tachometer reads at the encoder's speed.");
  const Axis error{"tachometer error", units.speed};
  report.add(
      against("Against speed", speed, error, models, samples, &ResidualSamples::w, &ResidualSamples::tach_error));
  report.add(against("Against acceleration", acceleration, error, models, samples, &ResidualSamples::acceleration,
                     &ResidualSamples::tach_error));
}

}  // namespace host
