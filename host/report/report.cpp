#include "host/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "host/atomic_file.hpp"
#include "host/report/assets.hpp"
#include "host/report/html_blocks.hpp"
#include "host/report/plot_json.hpp"
#include "host/report/polar_svg.hpp"
#include "host/report/text_format.hpp"

namespace host {

namespace {

/// Traces with fewer rows are not decimated, because a screen shows them all.
constexpr std::size_t fewest_rows = 2000;

constexpr const char* zoom_hint =
    "Drag to zoom, drag with Shift to pan, double-click to see everything. The cursor is shared; a click sets its "
    "reference, and Δ shows the differences.";

/// The browser may use only the scripts and styles in the file; nothing is fetched.
constexpr const char* content_policy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";

void require(bool condition, const std::string& plot, const std::string& what) {
  if (!condition) throw std::invalid_argument(fmt::format("plot \"{}\": {}", plot, what));
}

/// Writes each block, and collects the data of the blocks that a script draws.
struct BlockWriter {
  std::size_t max_rows;
  std::string body = {};
  nlohmann::json plots = nlohmann::json::array();

  void operator()(const TimePlot& plot) {
    body += html::plot_frame(plots.size(), html::FrameWidth::full, plot.title, plot.caption, zoom_hint);
    plots.push_back(time_plot_json(plot, max_rows));
  }
  void operator()(const ScatterPlot& plot) {
    body += html::plot_frame(plots.size(), plot.large ? html::FrameWidth::full : html::FrameWidth::half, plot.title,
                             plot.caption, "");
    plots.push_back(scatter_plot_json(plot));
  }
  void operator()(const HeatMap& map) {
    body += html::plot_frame(plots.size(), html::FrameWidth::half, map.title, map.caption, "");
    plots.push_back(heat_map_json(map));
  }
  void operator()(const PolarPlot& plot) { body += html::polar_plot(plot); }
  void operator()(const BarChart& chart) { body += html::bar_chart(chart); }
  void operator()(const Table& table) { body += html::table(table); }
  void operator()(const Facts& facts) { body += html::facts(facts); }

  template <typename Section>
  void operator()(const Section& section) {
    body += fmt::format("<h2>{}</h2>\n", escape_html(section.heading));
    if (!section.text.empty()) body += fmt::format("<p class=\"lead\">{}</p>\n", escape_html(section.text));
  }
};

}  // namespace

Report::Report(std::string title, std::string subtitle) : title_(std::move(title)), subtitle_(std::move(subtitle)) {}

void Report::verdict(Verdict verdict) { verdict_ = std::move(verdict); }

void Report::section(std::string heading, std::string text) {
  blocks_.emplace_back(Section{std::move(heading), std::move(text)});
}

void Report::add(TimePlot plot) {
  for (const TracePanel& panel : plot.panels) {
    for (const TimeTrace& trace : panel.traces) {
      require(trace.values.size() == plot.t_s.size(), plot.title,
              fmt::format("trace \"{}\" has {} samples, the time axis {}", trace.name, trace.values.size(),
                          plot.t_s.size()));
    }
  }
  blocks_.emplace_back(std::move(plot));
}

void Report::add(ScatterPlot plot) {
  for (const ScatterSeries& series : plot.series) {
    require(series.x.size() == series.y.size(), plot.title,
            fmt::format("series \"{}\" has {} x and {} y", series.name, series.x.size(), series.y.size()));
    const bool without_bars = series.lower.empty() && series.upper.empty();
    require(without_bars || (series.lower.size() == series.y.size() && series.upper.size() == series.y.size()),
            plot.title, fmt::format("series \"{}\" has error bars of another length", series.name));
  }
  blocks_.emplace_back(std::move(plot));
}

void Report::add(HeatMap map) {
  require(map.values.size() == map.x.count * map.y.count, map.title,
          fmt::format("{} values for {} x {} cells", map.values.size(), map.x.count, map.y.count));
  require(map.limit > 0.0, map.title, "its limit must be above 0");
  blocks_.emplace_back(std::move(map));
}

void Report::add(PolarPlot plot) {
  for (const PolarTrace& trace : plot.traces)
    require(trace.angle_rad.size() == trace.deviation_um.size(), plot.title,
            fmt::format("trace \"{}\" has {} angles and {} deviations", trace.name, trace.angle_rad.size(),
                        trace.deviation_um.size()));
  blocks_.emplace_back(std::move(plot));
}

void Report::add(BarChart chart) { blocks_.emplace_back(std::move(chart)); }
void Report::add(Table table) { blocks_.emplace_back(std::move(table)); }
void Report::add(Facts facts) { blocks_.emplace_back(std::move(facts)); }

std::size_t Report::rows_within_budget(std::size_t trace_budget) const {
  const auto samples_with = [&](std::size_t max_rows) {
    std::size_t samples = 0;
    for (const Block& block : blocks_) {
      const auto* plot = std::get_if<TimePlot>(&block);
      if (plot == nullptr) continue;
      // Every panel has its own time column.
      for (const TracePanel& panel : plot->panels) {
        samples += std::min(plot->t_s.size(), max_rows) * (panel.traces.size() + 1);
      }
    }
    return samples;
  };
  std::size_t rows = std::max(trace_budget, fewest_rows);
  while (rows > fewest_rows && samples_with(rows) > trace_budget) rows = std::max(fewest_rows, rows * 9 / 10);
  return rows;
}

std::string Report::html(std::size_t trace_budget) const {
  BlockWriter writer{rows_within_budget(trace_budget)};
  for (const Block& block : blocks_) std::visit(writer, block);

  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{} · axistool</title>\n"
      "<link rel=\"icon\" href=\"data:,\">\n<style>\n",
      content_policy, escape_html(title_));
  page += assets::dygraphs_style();
  page += assets::report_style();
  page += fmt::format("</style>\n</head>\n<body>\n<main>\n<header><h1>{}</h1><p>{}</p></header>\n", escape_html(title_),
                      escape_html(subtitle_));
  page += html::verdict(verdict_);
  page += "<div class=\"blocks\">\n" + writer.body + "</div>\n";
  page += "</main>\n<script type=\"application/json\" id=\"plots\">";
  page += script_safe_json(writer.plots);
  page += "</script>\n<script>\n";
  page += assets::dygraphs_script();
  page += "\n";
  page += assets::synchronizer_script();
  page += "</script>\n<script>\n";
  page += assets::heat_map_script();
  page += assets::report_script();
  page += "</script>\n</body>\n</html>\n";
  return page;
}

void Report::write(const std::string& path) const { write_file_atomically(path, html()); }

}  // namespace host
