// Content of a report: each struct is one figure or block, which the caller fills in physical units.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace host {

/// Meaning of a series. It determines the colour, so that a quantity has the same colour in every figure.
enum class SeriesRole { measured, predicted, residual, before, after, train, validate, floor, model, other };

enum class Tone { good, attention, bad, neutral };

/// The answer in plain words, at the top of the report.
struct Verdict {
  Tone tone = Tone::neutral;
  std::string label;                   ///< one or two words, e.g. "effect missing"
  std::string headline;                ///< one sentence
  std::vector<std::string> sentences;  ///< the reasons, and the next step
  std::string command;                 ///< the command for the next step; may be empty
  std::vector<std::string> details{};  ///< further sentences, which the workbench shows on demand
};

/// One trace over the time axis of its plot, with as many values as `TimePlot::t_s`. NaN makes a gap.
struct TimeTrace {
  std::string name;
  SeriesRole role = SeriesRole::measured;
  std::vector<double> values;
};

/// Traces with a common vertical axis.
struct TracePanel {
  std::string quantity;  ///< e.g. "speed"
  std::string unit;      ///< e.g. "rad/s"
  std::vector<TimeTrace> traces;
};

/// A shaded time range, e.g. the windows with the largest error.
struct TimeSpan {
  double from_s = 0.0;
  double to_s = 0.0;
};

/// Stacked traces with one time axis. They zoom and pan together and have a common cursor.
struct TimePlot {
  std::string title;
  std::string caption;
  std::vector<double> t_s;  ///< increasing
  std::vector<TracePanel> panels;
  std::vector<TimeSpan> shaded;
};

enum class SeriesStyle { line, points, line_and_points, stems };

/// y over x. With `lower` and `upper` (both as long as y), a line gets a band and points get error bars. NaN makes a
/// gap.
struct ScatterSeries {
  std::string name;
  SeriesRole role = SeriesRole::measured;
  SeriesStyle style = SeriesStyle::points;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> lower;
  std::vector<double> upper;
  std::vector<double> samples = {};  ///< number of samples per point: strip below the plot, value at the cursor
  bool dashed = false;               ///< dashed line
};

struct Axis {
  std::string quantity;
  std::string unit;
};

/// A quantity over another one: residual over speed, position or acceleration; a friction curve; an order spectrum
/// (stems).
struct ScatterPlot {
  std::string title;
  std::string caption;
  Axis x;
  Axis y;
  std::vector<ScatterSeries> series;
  bool logarithmic_y = false;  ///< values <= 0 become gaps
  bool equal_scales = false;   ///< equal scales of x and y, for paths in a plane
  bool logarithmic_x = false;  ///< every x > 0
  bool large = false;          ///< full width and twice the height, for the most important figure
  std::optional<std::pair<double, double>> y_range = {};  ///< initial range, so that plots can be compared
};

/// The mean of a value over a grid of two coordinates, in colours that diverge from zero.
struct HeatMap {
  /// Cells along a coordinate from `first` on, each of width `step`.
  struct Cells {
    Axis axis;
    double first = 0.0;
    double step = 1.0;
    std::size_t count = 0;
  };
  std::string title;
  std::string caption;
  Cells x, y;
  Axis value;
  std::vector<double> values;  ///< y.count rows of x.count values; NaN for empty cells
  double limit = 1.0;          ///< > 0; this and larger magnitudes have the strongest colour
};

/// One or several turns of the path: angle on the circle, and radial deviation (positive: outwards).
struct PolarTrace {
  std::string name;
  SeriesRole role = SeriesRole::measured;
  std::vector<double> angle_rad;
  std::vector<double> deviation_um;
};

/// Deviations from a circle, drawn magnified relative to the circle as in ISO 230-4.
struct PolarPlot {
  std::string title;
  std::string caption;
  double radius_mm = 1.0;
  std::vector<PolarTrace> traces;
};

struct BarRow {
  std::string label;
  std::vector<double> values;  ///< >= 0, one per series of the chart; NaN if there is none
  std::string note;            ///< shown after the label
};

struct BarSeries {
  std::string name;
  SeriesRole role = SeriesRole::measured;
};

/// Horizontal bars: error by regime, error by step, candidates before and after.
struct BarChart {
  std::string title;
  std::string caption;
  std::string unit;  ///< unit after each value; may be "%" or ""
  std::vector<BarSeries> series;
  std::vector<BarRow> rows;
  std::optional<std::pair<std::string, double>> reference;  ///< a vertical line: name and value
  bool folded = false;  ///< only the title is shown until the reader opens the chart

  /// Length of the longest bar, or the reference if that is larger; above 0.
  double longest() const {
    double most = reference ? reference->second : 0.0;
    for (const BarRow& row : rows)
      for (const double value : row.values)
        if (std::isfinite(value)) most = std::max(most, value);
    return most > 0.0 ? most : 1.0;
  }
};

/// Rows of text. A column in which every cell starts with a number is aligned right.
struct Table {
  std::string title;
  std::string caption;
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> links = {};  ///< links of the first cells to files; may be empty
  bool stacks = false;                  ///< on a narrow screen each row becomes a block with the headings
};

/// Pairs of name and value in a compact layout.
struct Facts {
  std::string title;
  std::vector<std::pair<std::string, std::string>> items;
};

}  // namespace host
