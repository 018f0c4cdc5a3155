// One self-contained HTML file with zoomable plots, which also works offline and as an attachment.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "host/report/content.hpp"

namespace host {

/// Collects the content in reading order. All text is plain text and is escaped on output.
class Report {
 public:
  /// `subtitle`: names of the model and the records.
  explicit Report(std::string title, std::string subtitle = "");

  /// The verdict; always shown at the top.
  void verdict(Verdict verdict);

  /// Begins a section; `text` (may be empty) explains it to the reader.
  void section(std::string heading, std::string text = "");

  /// Figures and tables are added to the last section. Throws std::invalid_argument if the series of a plot have
  /// different lengths.
  void add(TimePlot plot);
  void add(ScatterPlot plot);
  void add(HeatMap map);
  void add(PolarPlot plot);
  void add(BarChart chart);
  void add(Table table);
  void add(Facts facts);

  /// The complete file. If the traces have more than `trace_budget` samples in total (4 bytes each in the file), they
  /// are decimated.
  std::string html(std::size_t trace_budget = 400'000) const;

  /// Writes html() by write_file_atomically. Throws as that does.
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
