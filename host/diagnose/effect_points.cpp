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

/// One measured channel and its prediction.
struct Channel {
  std::vector<double> Record::*measured;
  std::vector<double> Prediction::*predicted;
  Axis axis;
  double factor;  ///< from the drive's unit to that of the axis
};

EffectPoints window_points(const Channel& channel, const PreparedRecord& prepared, const Window& window,
                           const Prediction& before, const Prediction& after) {
  const Record& record = *prepared.record;
  EffectPoints points;
  points.x = {"time", "s"};
  points.y = channel.axis;
  const std::vector<double>&measured = record.*channel.measured, &less = before.*channel.predicted,
        &more = after.*channel.predicted;
  for (std::size_t row = window.begin + 1; row <= window.begin + window.length; ++row) {
    points.at.push_back(record.t_s[row] - record.t_s.front());
    points.residual.push_back(channel.factor * (measured[row] - less[row]));
    points.part.push_back(channel.factor * (more[row] - less[row]));
    points.forward.push_back(prepared.motion().w[row] > 0.0);
  }
  return points;
}

/// Measured and predicted channel and the command in the same window.
TimePlot window_traces(const Channel& channel, const PreparedRecord& prepared, const Window& window,
                       const Prediction& before, const Prediction& after, sim::DriveKind kind) {
  const Record& record = *prepared.record;
  const auto part = [&](const std::vector<double>& values, double offset = 0.0) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(window.begin) + 1;
    std::vector<double> rows(first, first + static_cast<std::ptrdiff_t>(window.length));
    for (double& value : rows) value -= offset;
    return rows;
  };
  const bool is_speed = channel.measured == &Record::w;
  TimePlot plot;
  plot.title = "Measured and predicted in that time";
  plot.t_s = part(record.t_s, record.t_s.front());
  plot.panels = {{is_speed ? "speed" : "position",
                  is_speed ? units_of(kind).speed : units_of(kind).travel,
                  {{"measured", SeriesRole::measured, part(record.*channel.measured)},
                   {"without the effect", SeriesRole::before, part(before.*channel.predicted)},
                   {"with it", SeriesRole::after, part(after.*channel.predicted)}}},
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
  const auto rows_of = [&](double time_s) { return static_cast<std::size_t>(std::ceil(time_s / prepared.period_s)); };
  const std::size_t unseen = rows_of(kUnseen_s);
  std::vector<Breakaway> starts;
  std::vector<double> efforts;  // of the present rest
  std::size_t begin = 0;        // its first row
  sim::DriveState state = drive.at(record.x.front(), 0.0);
  for (std::size_t row = 0; row + unseen < record.size(); ++row) {
    sim::DriveState standing = state;
    efforts.push_back(drive.follow(state, prepared.u_V[row], prepared.motion().x[row + 1], prepared.motion().w[row + 1],
                                   record.t_s[row], prepared.period_s));
    if (std::abs(record.x[row + 1] - record.x[begin]) < kStep * resolution) continue;
    if (begin > 0 && efforts.size() > rows_of(kShortest_s)) {
      standing.w = 0.0;
      standing.rest_s = static_cast<double>(efforts.size()) * prepared.period_s;
      Breakaway start{standing.rest_s, 0.0, 0.0, record.x[row + unseen] > record.x[row], standing, record.t_s[row]};
      for (std::size_t k = 0; k < efforts.size(); ++k) {
        const double pushing = start.forward ? efforts[k] : -efforts[k];
        start.broke = std::max(start.broke, pushing);
        if (k + unseen < efforts.size()) start.held = std::max(start.held, pushing);
      }
      starts.push_back(std::move(start));
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
  const DriveUnits units = units_of(with.data.kind);
  const std::array channels{
      Channel{&Record::w, &Prediction::w, {"speed residual", units.speed}, 1.0},
      Channel{&Record::x, &Prediction::x, {"position residual", "µm"}, 1e3 * travel_in_mm(with.data.kind)}};
  const sim::Drive less(without), more(with);
  std::array<EffectPoints, channels.size()> best;
  std::array<double, channels.size()> highest{};
  Prediction before, after;
  for (const ComparedRecord& compared : set.records) {
    PreparedRecord prepared = in_long_windows(compared.prepared, kLength_s);
    if (prepared.windows.empty()) prepared = compared.prepared;
    predict(less, prepared, before);
    predict(more, prepared, after);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      if ((prepared.record->*channels[c].measured).size() != prepared.record->size()) continue;
      for (const Window& window : prepared.windows) {
        EffectPoints points = window_points(channels[c], prepared, window, before, after);
        const double share = points.explained_share();
        // A clear window counts by what the effect explains; any other by its share, below all clear ones.
        const double rank =
            share >= kClear ? 1.0 + explained_squares(without_line(points.residual), without_line(points.part)) : share;
        if (rank <= highest[c]) continue;
        highest[c] = rank;
        points.context = window_traces(channels[c], prepared, window, before, after, with.data.kind);
        points.caption = fmt::format("The {:.2g} s of {} in which the effect shows most.",
                                     points.at.back() - points.at.front(), file_name(*prepared.record));
        best[c] = std::move(points);
      }
    }
  }
  EffectPoints& shown = best[0].at.empty() ? best[1] : best[0];
  if (shown.at.empty()) return {};
  return std::move(shown);
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
      all.emplace_back(std::move(start), std::array{fresh, rested});
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
