#include "host/compare/error_figures.hpp"

#include <algorithm>
#include <cmath>

#include "host/evidence/measured_sensors.hpp"
#include "host/record/columns.hpp"

namespace host {

namespace {

/// Sums of one channel over windows.
struct ChannelSums {
  double error = 0.0, floor = 0.0, values = 0.0, squares = 0.0, signal = 0.0;
  std::size_t rows = 0;

  /// `over_floor`: mean squared error over the squared noise floor. `origin`: zero of the signal.
  void add_window(const std::vector<double>& measured, const Window& window, double over_floor, double window_floor,
                  double origin) {
    const auto n = static_cast<double>(window.length);
    error += n * over_floor * window_floor * window_floor;
    floor += n * window_floor * window_floor;
    rows += window.length;
    for (std::size_t k = window.begin + 1; k <= window.begin + window.length; ++k) {
      values += measured[k];
      squares += measured[k] * measured[k];
      signal += (measured[k] - origin) * (measured[k] - origin);
    }
  }

  void append_to(std::vector<ChannelFigures>& channels, std::string_view name, const char* unit) const {
    if (rows == 0) return;
    const auto n = static_cast<double>(rows);
    const double spread = std::max(0.0, squares - values * values / n);
    ChannelFigures channel{std::string(name), unit, std::sqrt(error / n)};
    channel.fit_percent = spread > 0.0 ? 100.0 * (1.0 - std::sqrt(error / spread)) : 0.0;
    if (signal > 0.0) channel.share = std::sqrt(error / signal);
    channel.floor = std::sqrt(floor / n);
    channels.push_back(std::move(channel));
  }
};

}  // namespace

const ChannelFigures* ErrorFigures::worst() const {
  const auto most = std::ranges::max_element(channels, {}, &ChannelFigures::over_floor);
  return most == channels.end() ? nullptr : &*most;
}

RecordSet figure_set(const sim::DriveDescription& model, const std::vector<FigureRecord>& records, double window_s) {
  RecordSet set;
  for (const auto& [record, windows] : records) {
    const sim::DriveDescription own = with_measured_sensors(model, {record});
    ComparedRecord compared{prepare(*record, own, window_s), {}};
    if (windows) compared.prepared.windows = *windows;
    renew_floor(compared.floor, own, sim::Drive(own), compared.prepared, set.stride);
    set.records.push_back(std::move(compared));
  }
  return set;
}

ErrorFigures figures_of(const SetError& error, const RecordSet& set, std::optional<std::size_t> record) {
  ErrorFigures figures;
  ChannelSums x, w;
  double combined = 0.0;
  std::size_t scores = 0;
  sim::DriveKind kind = sim::DriveKind::rotary;
  for (const WindowScore& score : error.windows) {
    if (record && score.record != *record) continue;
    const auto& [prepared, floor, effort] = set.records[score.record];
    const Window& window = prepared.windows[score.window];
    figures.window_s = prepared.window_s();
    kind = prepared.record->kind;
    if (!floor.w.empty()) w.add_window(prepared.record->w, window, score.w, floor.w[score.window], 0.0);
    if (!floor.x.empty())
      x.add_window(prepared.record->x, window, score.x, floor.x[score.window], prepared.record->x[window.begin]);
    scores += (floor.x.empty() ? 0 : 1) + (floor.w.empty() ? 0 : 1);
    combined += score.x + score.w;
  }
  const bool rotary = kind == sim::DriveKind::rotary;
  w.append_to(figures.channels, column_name(&Record::w, kind), rotary ? "rad/s" : "m/s");
  x.append_to(figures.channels, column_name(&Record::x, kind), rotary ? "mm" : "m");
  figures.combined = scores == 0 ? 0.0 : std::sqrt(combined / static_cast<double>(scores));
  return figures;
}

ErrorFigures error_figures(const sim::DriveDescription& model, const std::vector<FigureRecord>& records,
                           double window_s) {
  const RecordSet set = figure_set(model, records, window_s);
  ErrorFigures figures = figures_of(error_of(sim::Drive(model), set), set);
  figures.window_s = window_s;
  return figures;
}

nlohmann::json to_json(const ErrorFigures& figures) {
  nlohmann::json channels = nlohmann::json::object();
  for (const ChannelFigures& channel : figures.channels)
    channels[channel.name] = {{"unit", channel.unit},
                              {"rms", channel.rms},
                              {"share", channel.share ? nlohmann::json(*channel.share) : nlohmann::json(nullptr)},
                              {"floor", channel.floor},
                              {"over_floor", channel.over_floor()}};
  return {{"measure", "motion"},
          {"window_s", figures.window_s},
          {"channels", std::move(channels)},
          {"combined", figures.combined}};
}

}  // namespace host
