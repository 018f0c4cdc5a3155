#include "host/diagnose/diagnosis_figures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "host/compare/effort_residual.hpp"
#include "host/record/drive_units.hpp"
#include "host/report/binned_curve.hpp"
#include "host/report/text_format.hpp"

namespace host {

namespace {

/// Samples of all validation records, thinned to what curves of a hundred bins need.
ResidualSamples residuals_on(const sim::DriveDescription& model, const RecordSet& set) {
  constexpr std::size_t kEnough = 30'000;
  std::size_t rows = 0;
  for (const ComparedRecord& compared : set.records) rows += compared.prepared.record->size();
  return residual_samples(model, set, 1 + rows / kEnough);
}

ScatterSeries curve(const std::string& name, SeriesRole role, const std::vector<double>& x,
                    const std::vector<double>& y) {
  constexpr std::size_t kMostBins = 160, kFewestBins = 8, kSamplesABin = 40, kFewestSamples = 20;
  const std::size_t bins = std::clamp(x.size() / kSamplesABin, kFewestBins, kMostBins);
  return curve_series(name, role, binned_curve(x, y, bins, kFewestSamples));
}

ScatterPlot before_and_after(const std::string& title, const std::string& caption, const Axis& x, const Axis& y,
                             const std::vector<double>& before_x, const std::vector<double>& before_y,
                             const std::vector<double>& after_x, const std::vector<double>& after_y) {
  ScatterPlot plot;
  plot.title = title;
  plot.caption = caption;
  plot.x = x;
  plot.y = y;
  plot.series = {curve("before", SeriesRole::before, before_x, before_y),
                 curve("after", SeriesRole::after, after_x, after_y)};
  return plot;
}

/// Position modulo the period of the effect that was found, or one motor turn.
std::vector<double> folded(const std::vector<double>& x, double period) {
  std::vector<double> result;
  for (const double value : x) result.push_back(value - period * std::floor(value / period));
  return result;
}

/// The model's period along the travel, else that of the likeliest candidate that has one, else a turn of the shaft.
std::optional<double> period_of(const sim::DriveDescription& model, const Diagnosis& diagnosis) {
  for (const sim::EffectEntry& entry : model.effects)
    if (entry.has("period")) return entry.at("period");
  for (const JudgedCandidate& candidate : diagnosis.candidates)
    if (const sim::EffectEntry& last = candidate.model.effects.back(); last.has("period")) return last.at("period");
  constexpr double kTurn_rad = 6.283185307179586;
  if (model.data.kind == sim::DriveKind::linear) return {};
  return kTurn_rad * model.data.lead;
}

}  // namespace

void add_residuals(Report& report, const Diagnosis& diagnosis, const sim::DriveDescription& best) {
  const DriveUnits units = units_of(best.data.kind);
  const ResidualSamples before = residuals_on(diagnosis.base, diagnosis.validation);
  const ResidualSamples after = residuals_on(best, diagnosis.validation);
  report.section(
      "Where it shows",
      "What the motor gave beyond what the model explains, on validation data, averaged over each coordinate, with "
      "the band that holds 80 % of the samples. A flat line at zero is what a complete model leaves. Where there are "
      "no samples the line breaks; the strip at the foot shows how many there are.");
  const auto add = [&report](ScatterPlot plot) {
    if (std::ranges::any_of(plot.series, [](const ScatterSeries& series) { return series.x.size() < 2; })) return;
    report.add(std::move(plot));
  };
  const Axis effort{"unexplained effort", units.effort};
  add(before_and_after("Against speed", "", {"speed", units.speed}, effort, before.w, before.missing, after.w,
                       after.missing));
  if (const std::optional<double> period = period_of(best, diagnosis))
    add(before_and_after(fmt::format("Against position within one period of {:.4g} {}", *period, units.travel), "",
                         {"position in the period", units.travel}, effort, folded(before.x, *period), before.missing,
                         folded(after.x, *period), after.missing));
  add(before_and_after("Along the travel", "", {"position", units.travel}, effort, before.x, before.missing, after.x,
                       after.missing));
  add(before_and_after("Against acceleration", "", {"acceleration", units.acceleration}, effort, before.acceleration,
                       before.missing, after.acceleration, after.missing));
  add(before_and_after("Over time", "", {"time since start", "s"}, effort, before.t_s, before.missing, after.t_s,
                       after.missing));
  if (!before.tach_error.empty())
    add(before_and_after("Tachometer against speed", "Tachometer less the speed from the encoder.",
                         {"speed", units.speed}, {"tachometer error", units.speed}, before.w, before.tach_error,
                         after.w, after.tach_error));
}

namespace {

ScatterPlot correlation_plot(const std::string& title, const std::string& caption, const Correlation& correlation) {
  ScatterPlot plot{title, caption, {"lag", "ms"}, {"correlation", ""}, {}};
  std::vector<double> lag_ms;
  for (const double lag_s : correlation.lag_s) lag_ms.push_back(1e3 * lag_s);
  const std::vector<double> zero(lag_ms.size(), 0.0), bound(lag_ms.size(), correlation.bound),
      below(lag_ms.size(), -correlation.bound);
  plot.series = {{"99 % of a white residual", SeriesRole::floor, SeriesStyle::line, lag_ms, zero, below, bound},
                 {"correlation", SeriesRole::residual, SeriesStyle::stems, lag_ms, correlation.value, {}, {}}};
  return plot;
}

}  // namespace

void add_whiteness(Report& report, const Diagnosis& diagnosis) {
  const ResidualTests& tests = diagnosis.residual;
  if (tests.dependences.empty()) return;
  report.section(
      "Is what is left noise?",
      "The effort that the model leaves on validation data. Within the bounds it is white; a model of a real "
      "machine may leave them, so the verdict asks how much of it depends on something, and does so again in "
      "data that the dependence was not learnt on.");
  report.add(correlation_plot("Correlation with itself",
                              "The first 20 ms show the smoother that the effort comes from.", tests.with_itself));
  report.add(correlation_plot("Correlation with the command",
                              "At positive lags with earlier commands: a delay, a lag or a resonance shows there.",
                              tests.with_command));
  Table table;
  table.title = "What it depends on";
  table.headings = {"coordinate", "of the squared residual", "most"};
  for (const ResidualDependence& dependence : tests.dependences)
    table.rows.push_back(
        {spaced(dependence.coordinate), fmt::format("{:.1f} %", 100.0 * dependence.share), dependence.where});
  report.add(table);
}

void add_traces(Report& report, const Diagnosis& diagnosis, const sim::DriveDescription& best) {
  const DriveUnits units = units_of(best.data.kind);
  const ComparedRecord& compared = diagnosis.validation.records.front();
  const Record& record = *compared.prepared.record;
  Prediction before, after;
  predict(sim::Drive(diagnosis.base), compared.prepared, before);
  predict(sim::Drive(best), compared.prepared, after);
  // Between windows, and before the first, nothing is predicted.
  const auto shown = [&](const std::vector<double>& predicted, const std::vector<double>* less) {
    std::vector<double> values(record.size(), std::nan(""));
    for (const Window& window : compared.prepared.windows)
      for (std::size_t k = window.begin + 1; k <= window.begin + window.length; ++k)
        values[k] = less == nullptr ? predicted[k] : (*less)[k] - predicted[k];
    return values;
  };
  TimePlot plot;
  plot.title = "Measured and predicted";
  plot.caption = fmt::format("Prediction from the command alone, restarted every {:g} s from the smoothed measurement.",
                             diagnosis.window_s);
  plot.t_s = record.t_s;
  if (record.has_speed()) {
    plot.panels.push_back({"speed",
                           units.speed,
                           {{"measured", SeriesRole::measured, record.w},
                            {"predicted", SeriesRole::predicted, shown(after.w, nullptr)}}});
    plot.panels.push_back({"speed error",
                           units.speed,
                           {{"before", SeriesRole::before, shown(before.w, &record.w)},
                            {"after", SeriesRole::after, shown(after.w, &record.w)}}});
  }
  if (record.has_position())
    plot.panels.push_back({"position error",
                           units.travel,
                           {{"before", SeriesRole::before, shown(before.x, &record.x)},
                            {"after", SeriesRole::after, shown(after.x, &record.x)}}});
  report.section("Measured and predicted", fmt::format("Validation record {}.", record.path));
  report.add(plot);
}

BarChart candidate_chart(const Diagnosis& diagnosis) {
  BarChart chart;
  chart.title = "Candidates on validation data";
  chart.caption = "Error over floor with the effect added and all parameters fitted again; shorter is better.";
  chart.series = {{"without", SeriesRole::before}, {"with", SeriesRole::after}};
  chart.reference = {"floor", 1.0};
  constexpr std::size_t kShown = 10;
  for (std::size_t k = 0; k < std::min(kShown, diagnosis.candidates.size()); ++k) {
    const JudgedCandidate& candidate = diagnosis.candidates[k];
    chart.rows.push_back({fmt::format("{}", fmt::join(candidate.kinds, " + ")),
                          {candidate.before, candidate.after},
                          fmt::format("{:.0f} % probable", 100.0 * candidate.probability)});
  }
  return chart;
}

}  // namespace host
