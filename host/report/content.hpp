// Content of a report: each struct is one figure or block, filled by the caller in physical units.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace host {

/// Meaning of a series. It determines the colour, so a quantity has the same colour in every figure.
enum class SeriesRole { measured, predicted, residual, before, after, train, validate, floor, model, other };

enum class Tone { good, attention, bad, neutral };

/// The answer, in plain words, at the top of the report.
struct Verdict {
  Tone tone = Tone::neutral;
  std::string label;                   ///< one or two words, e.g. "effect missing"
  std::string headline;                ///< one sentence
  std::vector<std::string> sentences;  ///< why, and what to do next
  std::string command;                 ///< the command line that does it; may be empty
};

/// One trace over the time axis of its plot; as long as `TimePlot::t_s`. NaN leaves a gap.
struct TimeTrace {
  std::string name;
  SeriesRole role = SeriesRole::measured;
  std::vector<double> values;
};

/// Traces that share a vertical axis.
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

/// Stacked traces with one time axis: they zoom and pan together and share the cursor.
struct TimePlot {
  std::string title;
  std::string caption;
  std::vector<double> t_s;  ///< increasing
  std::vector<TracePanel> panels;
  std::vector<TimeSpan> shaded;
};

enum class SeriesStyle { line, points, line_and_points, stems };

/// y over x. With `lower` and `upper` (both as long as y) a line gets a band, points get error bars. NaN leaves a gap.
struct ScatterSeries {
  std::string name;
  SeriesRole role = SeriesRole::measured;
  SeriesStyle style = SeriesStyle::points;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> lower;
  std::vector<double> upper;
  std::vector<double> samples = {};  ///< number behind each point: a strip below the plot, shown at the cursor
  bool dashed = false;               ///< its line
};

struct Axis {
  std::string quantity;
  std::string unit;
};

/// Any quantity over another: residual over speed, position, acceleration; friction curve; order spectrum (stems).
struct ScatterPlot {
  std::string title;
  std::string caption;
  Axis x;
  Axis y;
  std::vector<ScatterSeries> series;
  bool logarithmic_y = false;  ///< values <= 0 leave gaps
  bool equal_scales = false;   ///< a unit of x is as long as a unit of y: for paths in a plane
  bool logarithmic_x = false;  ///< every x > 0
  bool large = false;          ///< full width and twice the height: for the most important figure
  std::optional<std::pair<double, double>> y_range = {};  ///< visible at first, so that two plots compare
};

/// The mean of a value over a grid in two coordinates, in colours that diverge from zero.
struct HeatMap {
  /// Cells along a coordinate, each `step` wide, from `first` on.
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
  std::vector<double> values;  ///< y.count rows of x.count; NaN where there is nothing
  double limit = 1.0;          ///< > 0; values of this size and more have the strongest colour
};

/// One or several turns of the path: angle on the circle, and deviation outwards (negative: inwards).
struct PolarTrace {
  std::string name;
  SeriesRole role = SeriesRole::measured;
  std::vector<double> angle_rad;
  std::vector<double> deviation_um;
};

/// Deviations from a circle, drawn about it and magnified, as in ISO 230-4.
struct PolarPlot {
  std::string title;
  std::string caption;
  double radius_mm = 1.0;
  std::vector<PolarTrace> traces;
};

struct BarRow {
  std::string label;
  std::vector<double> values;  ///< >= 0, one per series of the chart; NaN where there is none
  std::string note;            ///< shown behind the label
};

struct BarSeries {
  std::string name;
  SeriesRole role = SeriesRole::measured;
};

/// Horizontal bars: error by regime, the ladder of errors, candidates before and after.
struct BarChart {
  std::string title;
  std::string caption;
  std::string unit;  ///< behind each value; "%" and "" are fine
  std::vector<BarSeries> series;
  std::vector<BarRow> rows;
  std::optional<std::pair<std::string, double>> reference;  ///< a vertical line: name and value
  bool folded = false;                                      ///< the title alone is shown until the reader opens it

  /// Value of the longest bar, or the reference if larger; above 0.
  double longest() const {
    double most = reference ? reference->second : 0.0;
    for (const BarRow& row : rows)
      for (const double value : row.values)
        if (std::isfinite(value)) most = std::max(most, value);
    return most > 0.0 ? most : 1.0;
  }
};

/// Rows of text. A column whose every cell starts with a number is aligned right.
struct Table {
  std::string title;
  std::string caption;
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> links = {};  ///< files to which the first cells of the rows link; may be empty
  bool stacks = false;  ///< on a narrow screen each row becomes a separate block that repeats the headings
};

/// Pairs of name and value in a compact layout.
struct Facts {
  std::string title;
  std::vector<std::pair<std::string, std::string>> items;
};

}  // namespace host
