#include "host/compare/residual_spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/fourier.hpp"
#include "host/record/drive_units.hpp"

namespace host {

namespace {

constexpr std::size_t kWindow = 256;  // averages of 5 ms

/// The averages of a record in sequence; zero while the axis stands.
struct Slots {
  std::vector<double> value;
  std::vector<bool> moves;
};

std::vector<Slots> slots_of(const ResidualEffort& samples) {
  std::vector<Slots> records;
  for (std::size_t k = 0; k < samples.missing.size(); ++k) {
    if (!std::isfinite(samples.missing[k])) continue;
    if (samples.record[k] >= records.size()) records.resize(samples.record[k] + 1);
    Slots& record = records[samples.record[k]];
    const std::size_t slot = samples.slot[k];
    if (slot >= record.value.size()) {
      record.value.resize(slot + 1, 0.0);
      record.moves.resize(slot + 1, false);
    }
    record.value[slot] = samples.missing[k];
    record.moves[slot] = true;
  }
  return records;
}

}  // namespace

ScatterSeries spectrum_of_residual(const ResidualEffort& samples) {
  const std::vector<double> hann = hann_window(kWindow);
  std::vector<double> power(kWindow / 2 + 1, 0.0), windowed(kWindow);
  double weight = 0.0;
  for (const Slots& record : slots_of(samples))
    for (std::size_t begin = 0; begin + kWindow <= record.value.size(); begin += kWindow / 2) {
      const auto first = record.moves.begin() + static_cast<std::ptrdiff_t>(begin);
      if (2 * std::count(first, first + static_cast<std::ptrdiff_t>(kWindow), true) < static_cast<long>(kWindow))
        continue;
      for (std::size_t k = 0; k < kWindow; ++k) {
        windowed[k] = hann[k] * record.value[begin + k];
        if (record.moves[begin + k]) weight += hann[k] * hann[k];
      }
      const auto lines = spectrum_of(windowed);
      for (std::size_t line = 0; line < power.size(); ++line) power[line] += std::norm(lines[line]);
    }
  ScatterSeries spectrum{"residual", SeriesRole::residual, SeriesStyle::line, {}, {}, {}, {}};
  if (!(weight > 0.0)) return spectrum;
  for (std::size_t line = 1; line < power.size(); ++line) {
    spectrum.x.push_back(static_cast<double>(line) / (static_cast<double>(kWindow) * samples.period_s));
    spectrum.y.push_back(std::sqrt(2.0 * samples.period_s * power[line] / weight));
  }
  return spectrum;
}

void add_residual_spectrum(Report& report, std::span<const ResidualView> views, sim::DriveKind kind) {
  ScatterPlot plot;
  plot.title = "Spectrum";
  plot.caption = "Amplitude spectral density while the axis moves.";
  plot.x = {"frequency", "Hz"};
  const DriveUnits units = units_of(kind);
  plot.y = {kind == sim::DriveKind::rotary ? "missing torque" : "missing force", fmt::format("{}/√Hz", units.effort)};
  plot.logarithmic_x = plot.logarithmic_y = true;
  for (const ResidualView& view : views) {
    ScatterSeries spectrum = spectrum_of_residual(view.force);
    if (spectrum.x.empty()) continue;  // the record is too short
    if (views.size() > 1) {
      spectrum.name = view.name;
      spectrum.role = view.role;
    }
    plot.series.push_back(std::move(spectrum));
  }
  if (!plot.series.empty()) report.add(std::move(plot));
}

}  // namespace host
