// One self-contained HTML file: opens from a mail, works offline, plots zoom and pan.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "host/report/content.hpp"

namespace host {

/// Collects what to show, in reading order. All text is plain text: it is escaped on its way out.
class Report {
 public:
  /// `subtitle`: what was looked at, e.g. the model's and the records' names.
  explicit Report(std::string title, std::string subtitle = "");

  /// The verdict; always shown at the top.
  void verdict(Verdict verdict);

  /// Begins a section; `text` (may be empty) says what the reader should see in it.
  void section(std::string heading, std::string text = "");

  /// Figures and tables stand in the section begun last. Throws std::invalid_argument when the lengths of a plot's
  /// series do not fit together.
  void add(TimePlot plot);
  void add(ScatterPlot plot);
  void add(HeatMap map);
  void add(PolarPlot plot);
  void add(BarChart chart);
  void add(Table table);
  void add(Facts facts);

  /// The whole file. Traces that together exceed `trace_budget` samples (4 bytes each in the file) are decimated.
  std::string html(std::size_t trace_budget = 400'000) const;

  /// Writes html() through write_file_atomically; throws host::Failure as that does.
  void write(const std::string& path) const;

 private:
  struct Section {
    std::string heading;
    std::string text;
  };
  using Block = std::variant<Section, TimePlot, ScatterPlot, HeatMap, PolarPlot, BarChart, Table, Facts>;

  std::size_t rows_within_budget(std::size_t trace_budget) const;

  std::string title_;
  std::string subtitle_;
  Verdict verdict_;
  std::vector<Block> blocks_;
};

}  // namespace host
