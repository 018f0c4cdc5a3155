#include "host/diagnose/effect_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "host/record/drive_units.hpp"
#include "host/record/record_origin.hpp"

namespace host {

namespace {

double square(double value) { return value * value; }

/// Sum of the squared residual that the effect explains.
double explained_squares(const std::vector<double>& residual, const std::vector<double>& part) {
  double sum = 0.0;
  for (std::size_t k = 0; k < part.size(); ++k) sum += square(residual[k]) - square(residual[k] - part[k]);
  return sum;
}

/// The values at equal distances minus their straight line of least squares.
std::vector<double> without_line(std::vector<double> values) {
  const auto count = static_cast<double>(values.size());
  const double middle = 0.5 * (count - 1.0);
  double sum = 0.0, moment = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    sum += values[k];
    moment += values[k] * (static_cast<double>(k) - middle);
  }
  const double slope = 12.0 * moment / (count * (count * count - 1.0));
  for (std::size_t k = 0; k < values.size(); ++k) values[k] -= sum / count + slope * (static_cast<double>(k) - middle);
  return values;
}

/// Rows at each end of a window at which a slope over the position does not lie within it.
constexpr std::size_t kReach = 2;

/// Slope of the position in the unit of the speed.
std::vector<double> slopes_of(const std::vector<double>& x, double row_travel) {
  std::vector<double> slopes(x.size(), std::nan(""));
  for (std::size_t k = kReach; k + kReach < x.size(); ++k)
    slopes[k] = (x[k + kReach] - x[k - kReach]) / (2.0 * kReach * row_travel);
  return slopes;
}

/// Speeds of all rows, measured and predicted: the speed channel, or without one the slope of the position.
struct Speeds {
  std::vector<double> measured, without, with;
  bool by_slope;

  Speeds(const PreparedRecord& prepared, const Prediction& before, const Prediction& after, double lead)
      : measured(prepared.record->w), without(before.w), with(after.w), by_slope(!prepared.record->has_speed()) {
    if (!by_slope) return;
    const double row_travel = lead * prepared.period_s;
    measured = slopes_of(prepared.record->x, row_travel);
    without = slopes_of(before.x, row_travel);
    with = slopes_of(after.x, row_travel);
  }
};

/// The rows of a window in which the speeds are known.
std::pair<std::size_t, std::size_t> rows_of(const Window& window, const Speeds& speeds) {
  const std::size_t reach = speeds.by_slope ? kReach : 0;
  return {window.begin + 1 + reach, window.begin + window.length - reach};
}

EffectPoints window_points(const Speeds& speeds, const PreparedRecord& prepared, const Window& window) {
  const Record& record = *prepared.record;
  const auto [first, last] = rows_of(window, speeds);
  EffectPoints points;
  points.x = {"time", "s"};
  for (std::size_t row = first; row <= last; ++row) {
    points.at.push_back(record.t_s[row] - record.t_s.front());
    points.residual.push_back(speeds.measured[row] - speeds.without[row]);
    points.part.push_back(speeds.with[row] - speeds.without[row]);
    points.forward.push_back(prepared.motion().w[row] > 0.0);
  }
  return points;
}

/// Measured and predicted speed and the command in the same window.
TimePlot window_traces(const Speeds& speeds, const PreparedRecord& prepared, const Window& window,
                       const std::string& unit) {
  const auto [first, last] = rows_of(window, speeds);
  const auto part = [first = first, last = last](const std::vector<double>& values) {
    return std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(first),
                               values.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  };
  TimePlot plot;
  plot.title = "Measured and predicted in that time";
  plot.t_s = part(prepared.record->t_s);
  for (double& t_s : plot.t_s) t_s -= prepared.record->t_s.front();
  plot.panels = {{"speed",
                  unit,
                  {{"measured", SeriesRole::measured, part(speeds.measured)},
                   {"without the effect", SeriesRole::before, part(speeds.without)},
                   {"with it", SeriesRole::after, part(speeds.with)}}},
                 {"command", "V", {{"command", SeriesRole::other, part(prepared.u_V)}}}};
  return plot;
}

/// A start from rest.
struct Breakaway {
  double rest_s = 0.0;
  double held = 0.0, broke = 0.0;  ///< largest torque or force that certainly held it, and before it moved; >= 0
  bool forward = true;
  sim::DriveState state = {};  ///< at rest
  double t_s = 0.0;
};

/// The starts of a record with the torque or force of `drive`, Nm or N.
std::vector<Breakaway> starts_in(const sim::Drive& drive, const PreparedRecord& prepared, double resolution) {
  constexpr double kUnseen_s = 0.01, kShortest_s = 0.05, kStep = 1.5;
  const Record& record = *prepared.record;
  const auto rows_in = [&](double time_s) { return static_cast<std::size_t>(std::ceil(time_s / prepared.period_s)); };
  const std::size_t unseen = rows_in(kUnseen_s);
  std::vector<Breakaway> starts;
  std::vector<double> efforts;  // of the present rest
  std::size_t begin = 0;        // its first row
  sim::DriveState state = drive.at(record.x.front(), 0.0);
  for (std::size_t row = 0; row + unseen < record.size(); ++row) {
    sim::DriveState standing = state;
    efforts.push_back(drive.follow(state, prepared.u_V[row], prepared.motion().x[row + 1], prepared.motion().w[row + 1],
                                   record.t_s[row], prepared.period_s));
    if (std::abs(record.x[row + 1] - record.x[begin]) < kStep * resolution) continue;
    if (begin > 0 && efforts.size() > rows_in(kShortest_s)) {
      standing.w = 0.0;
      standing.rest_s = static_cast<double>(efforts.size()) * prepared.period_s;
      Breakaway start{standing.rest_s, 0.0, 0.0, record.x[row + unseen] > record.x[row], standing, record.t_s[row]};
      for (std::size_t k = 0; k < efforts.size(); ++k) {
        const double pushing = start.forward ? efforts[k] : -efforts[k];
        start.broke = std::max(start.broke, pushing);
        if (k + unseen < efforts.size()) start.held = std::max(start.held, pushing);
      }
      starts.push_back(start);
    }
    efforts.clear();
    begin = row + 1;
  }
  return starts;
}

}  // namespace

double EffectPoints::explained_share() const {
  const double all = std::inner_product(residual.begin(), residual.end(), residual.begin(), 0.0);
  return all > 0.0 ? explained_squares(residual, part) / all : 0.0;
}

std::optional<EffectPoints> moment_of(const sim::DriveDescription& without, const sim::DriveDescription& with,
                                      const RecordSet& set) {
  constexpr double kLength_s = 0.2, kClear = 0.9;
  const std::string unit = units_of(with.data.kind).speed;
  const sim::Drive less(without), more(with);
  EffectPoints shown;
  double highest = 0.0;
  Prediction before, after;
  for (const ComparedRecord& compared : set.records) {
    PreparedRecord prepared = in_long_windows(compared.prepared, kLength_s);
    if (prepared.windows.empty()) prepared = compared.prepared;
    predict(less, prepared, before);
    predict(more, prepared, after);
    const Speeds speeds(prepared, before, after, less.lead);
    for (const Window& window : prepared.windows) {
      EffectPoints points = window_points(speeds, prepared, window);
      const double share = points.explained_share();
      // A clear window counts by what the effect explains; any other by its share, below all clear ones.
      const double rank =
          share >= kClear ? 1.0 + explained_squares(without_line(points.residual), without_line(points.part)) : share;
      if (!(rank > highest)) continue;
      highest = rank;
      points.context = window_traces(speeds, prepared, window, unit);
      points.caption = fmt::format("The {:.2g} s of {} in which the effect shows most.",
                                   points.at.back() - points.at.front(), file_name(*prepared.record));
      shown = std::move(points);
    }
  }
  if (shown.at.empty()) return {};
  shown.y = {"speed residual", unit};
  return shown;
}

std::optional<EffectPoints> starts_of(const sim::DriveDescription& without, const sim::DriveDescription& with,
                                      const RecordSet& set) {
  constexpr double kWidest = 0.3;  // of the static friction
  constexpr std::size_t kFewest = 4;
  const sim::Drive less(without), more(with);
  std::vector<std::pair<Breakaway, std::array<double, 2>>> all;  // with the static friction without and with the effect
  for (const ComparedRecord& compared : set.records) {
    if (!compared.prepared.record->has_position()) continue;
    for (Breakaway& start : starts_in(more, compared.prepared, with.data.encoder_resolution)) {
      const double direction = start.forward ? start.broke : -start.broke;
      const double fresh = less.breakaway_effort(start.state, direction, start.t_s);
      const double rested = more.breakaway_effort(start.state, direction, start.t_s);
      if (start.broke - start.held > kWidest * fresh) continue;
      all.emplace_back(start, std::array{fresh, rested});
    }
  }
  if (all.size() < kFewest) return {};
  std::ranges::sort(all, {}, [](const auto& one) { return one.first.rest_s; });
  EffectPoints points;
  points.caption = "Each point is a start from rest, with the range of its breakaway.";
  points.x = {"rest before the start", "s"};
  points.logarithmic_x = true;
  points.y = {"breakaway beyond the model", units_of(with.data.kind).effort};
  for (const auto& [start, friction] : all) {
    points.at.push_back(start.rest_s);
    points.residual.push_back(0.5 * (start.held + start.broke) - friction[0]);
    points.lower.push_back(start.held - friction[0]);
    points.upper.push_back(start.broke - friction[0]);
    points.part.push_back(friction[1] - friction[0]);
    points.forward.push_back(start.forward);
  }
  return points;
}

void append_points(const EffectPoints& points, ScatterPlot& plot) {
  plot.x = points.x;
  plot.y = points.y;
  plot.logarithmic_x = points.logarithmic_x;
  std::vector<ScatterSeries> lines;
  for (const bool forward : {true, false}) {
    const std::string name = forward ? "forward" : "backward";
    ScatterSeries series{name, forward ? SeriesRole::residual : SeriesRole::other, SeriesStyle::points, {}, {}, {}, {}};
    ScatterSeries line{"effect, " + name, SeriesRole::model, SeriesStyle::line, {}, {}, {}, {}};
    line.dashed = !forward;
    for (std::size_t k = 0; k < points.at.size(); ++k) {
      if (points.forward[k] != forward) continue;
      series.x.push_back(points.at[k]);
      series.y.push_back(points.residual[k]);
      line.x.push_back(points.at[k]);
      line.y.push_back(points.part[k]);
      if (points.lower.empty()) continue;
      series.lower.push_back(points.lower[k]);
      series.upper.push_back(points.upper[k]);
    }
    if (series.x.empty()) continue;
    plot.series.push_back(std::move(series));
    lines.push_back(std::move(line));
  }
  if (points.is_record()) lines = {{"effect", SeriesRole::model, SeriesStyle::line, points.at, points.part, {}, {}}};
  for (ScatterSeries& line : lines) plot.series.push_back(std::move(line));
}

}  // namespace host
