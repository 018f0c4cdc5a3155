#include "host/scale/table_figures.hpp"

#include <fmt/format.h>

#include <utility>

#include "host/report/text_format.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

/// A plot of the rows over a coordinate, by direction.
ScatterPlot over(const TableRows& rows, const Eigen::VectorXd& along, std::string title, Axis axis) {
  ScatterPlot plot;
  plot.title = std::move(title);
  plot.x = std::move(axis);
  plot.y = {"x2 − x", "µm"};
  plot.series = {{"forward", SeriesRole::measured, SeriesStyle::points, {}, {}, {}, {}},
                 {"backward", SeriesRole::other, SeriesStyle::points, {}, {}, {}, {}}};
  for (Eigen::Index k = 0; k < rows.size(); ++k) {
    ScatterSeries& series = plot.series[rows.way(k) > 0.0 ? 0 : 1];
    series.x.push_back(along(k));
    series.y.push_back(rows.y(k));
  }
  return plot;
}

}  // namespace

void add_table_figures(const TableStudy& study, Report& report) {
  if (study.empty()) return;
  const TableRows& rows = study.rows;
  report.section("The table against the motor", table_words(study));
  Table table;
  table.headings = {"effect", "what", "size", "95 %", "unit"};
  for (const TableEffect& effect : study.effects)
    for (const TableSize& size : effect.sizes)
      table.rows.push_back({spaced(effect.kind()), spaced(size.name), format_value(size.value),
                            fmt::format("{} … {}", format_value(size.ci95[0]), format_value(size.ci95[1])), size.unit});
  if (!table.rows.empty()) report.add(std::move(table));
  report.add(over(rows, rows.x, "Over the travel", {"travel", "mm"}));
  report.add(over(rows, rows.since, "After a reversal", {"travel since the reversal", "mm"}));
  if (rows.has_effort()) report.add(over(rows, rows.effort, "Against the motor's effort", {"effort", "Nm or N"}));
  report.add(over(rows, rows.t_s, "Over time", {"time", "s"}));
  const TableEffect* pitch = study.find("pitch_error");
  if (pitch == nullptr) return;
  ScatterPlot plot;
  plot.title = "Pitch error";
  plot.caption = "What the screw adds to the travel, about its mean, with its 95 % band.";
  plot.x = {"travel", "mm"};
  plot.y = {"pitch error", "µm"};
  ScatterSeries line{"pitch error", SeriesRole::model, SeriesStyle::line, {}, {}, {}, {}};
  for (const TablePoint& point : pitch->curve) {
    line.x.push_back(point.x_mm);
    line.y.push_back(point.um);
    line.lower.push_back(point.um - kNormal95 * point.deviation_um);
    line.upper.push_back(point.um + kNormal95 * point.deviation_um);
  }
  plot.series.push_back(std::move(line));
  report.add(std::move(plot));
}

}  // namespace host
