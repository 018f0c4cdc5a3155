#include "host/report/plot_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>

#include "host/report/decimation.hpp"
#include "host/report/packed_samples.hpp"
#include "host/report/series_colour.hpp"
#include "host/report/text_format.hpp"

namespace host {

namespace {

constexpr std::size_t max_scatter_points = 4000;
constexpr int scatter_digits = 5;

const char* style_name(SeriesStyle style) {
  switch (style) {
    case SeriesStyle::line:
      return "line";
    case SeriesStyle::points:
      return "points";
    case SeriesStyle::line_and_points:
      return "line_and_points";
    case SeriesStyle::stems:
      break;
  }
  return "stems";
}

std::string axis_label(const std::string& quantity, const std::string& unit) {
  return unit.empty() ? quantity : quantity + " [" + unit + "]";
}

std::vector<double> picked(std::span<const double> values, std::span<const std::size_t> rows) {
  std::vector<double> kept;
  kept.reserve(rows.size());
  for (const std::size_t row : rows) kept.push_back(values[row]);
  return kept;
}

nlohmann::json packed_json(std::span<const double> values) {
  const PackedSamples packed = pack_samples(values);
  return {{"lowest", packed.lowest}, {"step", packed.step}, {"base64", packed.base64}};
}

nlohmann::json short_numbers(std::span<const double> values, int digits = scatter_digits) {
  nlohmann::json numbers = nlohmann::json::array();
  for (const double value : values) numbers.push_back(rounded_to_digits(value, digits));
  return numbers;
}

nlohmann::json cells_json(const HeatMap::Cells& cells) {
  return {{"label", axis_label(cells.axis.quantity, cells.axis.unit)},
          {"unit", cells.axis.unit},
          {"first", cells.first},
          {"step", cells.step},
          {"count", cells.count}};
}

nlohmann::json panel_json(const TracePanel& panel, const std::vector<double>& t_s, std::size_t max_rows) {
  std::vector<std::span<const double>> traces;
  for (const TimeTrace& trace : panel.traces) traces.emplace_back(std::span(trace.values).first(t_s.size()));
  const std::vector<std::size_t> rows = decimated_rows(traces, max_rows);
  nlohmann::json series = nlohmann::json::array();
  for (std::size_t k = 0; k < traces.size(); ++k) {
    series.push_back({{"name", panel.traces[k].name},
                      {"colour", series_colour(panel.traces[k].role)},
                      // A wide line, so that its edge remains visible below a prediction.
                      {"wide", panel.traces[k].role == SeriesRole::measured && traces.size() > 1},
                      {"y", packed_json(picked(traces[k], rows))}});
  }
  return {{"label", axis_label(panel.quantity, panel.unit)},
          {"unit", panel.unit},
          {"x", packed_json(picked(t_s, rows))},
          {"series", series}};
}

/// Rows sorted by x and thinned for drawing, without rows whose x is NaN.
std::vector<std::size_t> drawn_rows(const ScatterSeries& series) {
  std::vector<std::size_t> order(std::min(series.x.size(), series.y.size()));
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t row) { return !std::isfinite(series.x[row]); });
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return series.x[a] < series.x[b]; });
  const std::vector<double> y = picked(series.y, order);
  const std::span<const double> y_span = y;
  const std::vector<std::size_t> kept = series.style == SeriesStyle::points
                                            ? thinned_cloud(y_span, max_scatter_points)
                                            : decimated_rows({&y_span, 1}, max_scatter_points);
  std::vector<std::size_t> rows;
  rows.reserve(kept.size());
  for (const std::size_t row : kept) rows.push_back(order[row]);
  return rows;
}

}  // namespace

nlohmann::json time_plot_json(const TimePlot& plot, std::size_t max_rows) {
  nlohmann::json panels = nlohmann::json::array();
  for (const TracePanel& panel : plot.panels) panels.push_back(panel_json(panel, plot.t_s, max_rows));
  nlohmann::json shaded = nlohmann::json::array();
  for (const TimeSpan& span : plot.shaded) shaded.push_back({span.from_s, span.to_s});
  return {{"kind", "time"}, {"xLabel", "time [s]"}, {"panels", panels}, {"shaded", shaded}};
}

nlohmann::json scatter_plot_json(const ScatterPlot& plot) {
  nlohmann::json all = nlohmann::json::array();
  for (const ScatterSeries& series : plot.series) {
    const std::vector<std::size_t> rows = drawn_rows(series);
    nlohmann::json one = {{"name", series.name},
                          {"colour", series_colour(series.role)},
                          {"style", style_name(series.style)},
                          {"dashed", series.dashed},
                          {"x", short_numbers(picked(series.x, rows))},
                          {"y", short_numbers(picked(series.y, rows))}};
    if (series.lower.size() == series.y.size() && series.upper.size() == series.y.size() && !series.y.empty()) {
      one["lower"] = short_numbers(picked(series.lower, rows));
      one["upper"] = short_numbers(picked(series.upper, rows));
    }
    if (series.samples.size() == series.y.size() && !series.y.empty())
      one["samples"] = short_numbers(picked(series.samples, rows));
    all.push_back(std::move(one));
  }
  nlohmann::json document = {{"kind", "scatter"},
                             {"xLabel", axis_label(plot.x.quantity, plot.x.unit)},
                             {"label", axis_label(plot.y.quantity, plot.y.unit)},
                             {"unit", plot.y.unit},
                             {"xUnit", plot.x.unit},
                             {"logarithmic", plot.logarithmic_y},
                             {"logarithmicX", plot.logarithmic_x},
                             {"equal", plot.equal_scales},
                             {"large", plot.large},
                             {"series", all}};
  if (plot.y_range) document["yRange"] = {plot.y_range->first, plot.y_range->second};
  return document;
}

nlohmann::json heat_map_json(const HeatMap& map) {
  constexpr int kDigits = 4;
  return {{"kind", "map"},
          {"x", cells_json(map.x)},
          {"y", cells_json(map.y)},
          {"label", axis_label(map.value.quantity, map.value.unit)},
          {"unit", map.value.unit},
          {"limit", map.limit},
          {"values", short_numbers(map.values, kDigits)}};
}

}  // namespace host
