#include "host/compare/residual_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "host/compare/effort_residual.hpp"
#include "host/compare/focus.hpp"
#include "host/identify/inverse_model.hpp"
#include "host/record/drive_units.hpp"
#include "host/report/binned_curve.hpp"
#include "host/statistics.hpp"

namespace host {

namespace {

using Values = std::vector<double>;

constexpr std::size_t kFewestSamples = 8;  // averages of 5 ms; a mean of fewer is too noisy

std::size_t bins_for(std::size_t samples) {
  constexpr std::size_t kMost = 120, kFewest = 8, kSamplesABin = 25;
  return std::clamp(samples / kSamplesABin, kFewest, kMost);
}

BinnedCurve curve_over(const ResidualCoordinate& over, Values x, const Values& y) {
  if (over.logarithmic)
    for (double& value : x) value = value == 0.0 ? std::nan("") : std::log10(std::abs(value));
  constexpr double kBinsAPeriod = 48.0;
  const std::size_t bins = over.folded ? static_cast<std::size_t>(kBinsAPeriod) : bins_for(x.size());
  BinnedCurve curve = binned_curve(x, y, bins, kFewestSamples, over.folded ? 0.0 : over.period);
  if (over.logarithmic)
    for (double& value : curve.x) value = std::pow(10.0, value);
  return curve;
}

/// The mean speed of its run for each sample, if all records are runs at constant speeds; otherwise empty. The speed
/// within a run varies by noise and ripple, which must not spread the run over several bins.
Values speeds_of_runs(const ResidualEffort& samples) {
  constexpr std::size_t kFewestRuns = 3;
  constexpr double kMostSpread = 0.25;  // the middle 80 % of a run's samples, over their median
  std::map<std::size_t, Values> runs;
  for (std::size_t k = 0; k < samples.w.size(); ++k) runs[samples.record[k]].push_back(samples.w[k]);
  if (runs.size() < kFewestRuns) return {};
  std::map<std::size_t, double> means;
  for (const auto& [record, speeds] : runs) {
    const double spread = quantile(speeds, 0.9) - quantile(speeds, 0.1);
    if (!(spread <= kMostSpread * std::abs(quantile(speeds, 0.5)))) return {};
    means[record] = std::accumulate(speeds.begin(), speeds.end(), 0.0) / static_cast<double>(speeds.size());
  }
  Values all;
  for (const std::size_t record : samples.record) all.push_back(means[record]);
  return all;
}

/// A curve whose line continues over intervals without samples.
BinnedCurve joined(const BinnedCurve& curve) {
  BinnedCurve all;
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    if (std::isnan(curve.mean[k])) continue;
    for (const auto values :
         {&BinnedCurve::x, &BinnedCurve::mean, &BinnedCurve::lower, &BinnedCurve::upper, &BinnedCurve::samples})
      (all.*values).push_back((curve.*values)[k]);
  }
  return all;
}

std::string effort_name(sim::DriveKind kind) { return kind == sim::DriveKind::rotary ? "torque" : "force"; }

void append(ScatterPlot& plot, std::vector<ScatterSeries> series) {
  for (ScatterSeries& one : series)
    if (!one.x.empty()) plot.series.push_back(std::move(one));
}

ScatterPlot plot_over(const ResidualCoordinate& over, const std::string& title, const Axis& value) {
  ScatterPlot plot;
  plot.title = title;
  plot.x = over.axis;
  plot.y = value;
  plot.logarithmic_x = over.logarithmic;
  return plot;
}

std::vector<ScatterSeries> in_one_colour(std::vector<ScatterSeries> curves, const ResidualView& view) {
  for (ScatterSeries& curve : curves) {
    curve.dashed = curve.name == "backward";
    curve.name = view.name + ", " + curve.name;
    curve.role = view.role;
    curve.lower.clear();
    curve.upper.clear();
    curve.samples.clear();
  }
  return curves;
}

/// Gives all plots the same vertical range: from the lowest to the highest end of a band.
void share_range(std::span<ScatterPlot> plots) {
  constexpr double kMargin = 0.06;
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const ScatterPlot& plot : plots)
    for (const ScatterSeries& series : plot.series) {
      for (const double value : series.lower.empty() ? series.y : series.lower)
        if (std::isfinite(value)) low = std::min(low, value);
      for (const double value : series.upper.empty() ? series.y : series.upper)
        if (std::isfinite(value)) high = std::max(high, value);
    }
  if (!(high > low)) return;
  const double margin = kMargin * (high - low);
  for (ScatterPlot& plot : plots) plot.y_range = {low - margin, high + margin};
}

/// Equal cells over the middle 98 % of the values, so that a few fast samples do not compress all others.
HeatMap::Cells cells_over(const Axis& axis, const Values& values, std::size_t count, double period) {
  constexpr double kLeftOut = 0.01;
  const double low = quantile(values, kLeftOut), high = quantile(values, 1.0 - kLeftOut);
  const double step = bin_width((high - low) / static_cast<double>(count), period);
  if (!(step > 0.0)) return {axis, low, 1.0, 0};
  const double first = step * std::floor(low / step);
  return {axis, first, step, 1 + static_cast<std::size_t>((high - first) / step)};
}

Values means_in(const HeatMap& map, const Values& x, const Values& y, const Values& values) {
  constexpr double kFewest = 3.0;
  Values sums(map.x.count * map.y.count), counts(sums.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double column = std::floor((x[k] - map.x.first) / map.x.step);
    const double row = std::floor((y[k] - map.y.first) / map.y.step);
    if (!(column >= 0.0) || !(row >= 0.0) || column >= static_cast<double>(map.x.count) ||
        row >= static_cast<double>(map.y.count))
      continue;
    const auto cell = static_cast<std::size_t>(row) * map.x.count + static_cast<std::size_t>(column);
    sums[cell] += values[k];
    ++counts[cell];
  }
  for (std::size_t cell = 0; cell < sums.size(); ++cell)
    sums[cell] = counts[cell] < kFewest ? std::nan("") : sums[cell] / counts[cell];
  return sums;
}

}  // namespace

std::vector<ResidualEffort> residuals_on(const std::vector<const sim::DriveDescription*>& models,
                                         const RecordSet& set) {
  const bool by_inverse =
      std::ranges::all_of(models, [](const auto* model) { return has_inverse(sim::Drive(*model)); });
  std::vector<ResidualEffort> residuals;
  for (const sim::DriveDescription* model : models)
    residuals.push_back(by_inverse ? residual_of_inverse(*model, set) : residual_effort(*model, set));
  return residuals;
}

Values ResidualCoordinate::of(const ResidualEffort& samples) const {
  Values values = samples.*along;
  for (double& value : values) {
    value *= factor;
    if (folded) value -= period * std::floor(value / period);
  }
  return values;
}

ResidualCoordinate coordinate_of(std::string_view name, sim::DriveKind kind, double period) {
  const DriveUnits units = units_of(kind);
  const double mm = travel_in_mm(kind);
  if (name == "position") return {{"position", "mm"}, &ResidualEffort::x, mm, mm * period};
  if (name == "phase") return {{"position in the period", "mm"}, &ResidualEffort::x, mm, mm * period, period > 0.0};
  if (name == "acceleration") return {{"acceleration", units.acceleration}, &ResidualEffort::acceleration};
  if (name == "current") return {{"command", "V"}, &ResidualEffort::command_V};
  if (name == "time") return {{"time since start", "s"}, &ResidualEffort::t_s};
  if (name == "temperature") return {{"temperature", "°C"}, &ResidualEffort::temp_C};
  if (name == "rest") return {{"rest before the motion", "s"}, &ResidualEffort::rest_s, 1.0, 0.0, false, true};
  if (name == "travel_since_reversal")
    return {{"travel since the reversal", "mm"}, &ResidualEffort::since_reversal, mm, 0.0, false, true};
  return {{"speed", units.speed}, &ResidualEffort::w};
}

double ripple_period(const sim::DriveDescription& model) {
  double longest = 0.0;
  for (const sim::EffectEntry& entry : model.effects)
    if (entry.has("period")) longest = std::max(longest, entry.at("period"));
  if (longest > 0.0) return longest;
  return model.data.turn();
}

std::vector<ScatterSeries> direction_curves(const ResidualEffort& samples, const Values& values,
                                            const ResidualCoordinate& over) {
  const Values runs = over.along == &ResidualEffort::w ? speeds_of_runs(samples) : Values{};
  const Values all = runs.empty() ? over.of(samples) : runs;
  std::vector<ScatterSeries> curves;
  for (const double sign : {1.0, -1.0}) {
    Values x, y;
    for (std::size_t k = 0; k < std::min(all.size(), values.size()); ++k) {
      if (samples.w[k] * sign <= 0.0) continue;
      x.push_back(all[k]);
      y.push_back(values[k]);
    }
    const BinnedCurve curve = curve_over(over, std::move(x), y);
    curves.push_back(curve_series(sign > 0.0 ? "forward" : "backward",
                                  sign > 0.0 ? SeriesRole::residual : SeriesRole::other,
                                  runs.empty() ? curve : joined(curve)));
  }
  return curves;
}

bool add_residual_plot(Report& report, const ResidualCoordinate& over, const std::string& title, const Axis& value,
                       std::span<const ResidualView> views, ResidualEffort ResidualView::*what, Layout layout,
                       const ResidualCoordinate* instead) {
  std::vector<ScatterPlot> plots;
  for (const ResidualView& view : views) {
    const ResidualEffort& samples = view.*what;
    std::vector<ScatterSeries> curves =
        direction_curves(samples, instead != nullptr ? instead->of(samples) : samples.missing, over);
    const bool own = views.size() == 1 || layout == Layout::side_by_side;
    if (own || plots.empty())
      plots.push_back(plot_over(over, own && views.size() > 1 ? title + ": " + view.name : title, value));
    append(plots.back(), own ? std::move(curves) : in_one_colour(std::move(curves), view));
  }
  if (std::ranges::any_of(plots, [](const ScatterPlot& plot) { return plot.series.empty(); })) return false;
  if (plots.size() > 1) share_range(plots);
  for (ScatterPlot& plot : plots) report.add(std::move(plot));
  return true;
}

void add_chosen_plot(Report& report, std::span<const ResidualView> views,
                     const std::pair<std::string, std::string>& names, sim::DriveKind kind, double period) {
  const auto& [x, y] = names;
  const bool is_error = y == kPlottedError;
  const ResidualCoordinate over = coordinate_of(x, kind, period), instead = coordinate_of(y, kind, period);
  const Axis value = is_error ? Axis{"missing " + effort_name(kind), units_of(kind).effort} : instead.axis;
  std::string title = fmt::format("{} against {}", value.quantity, over.axis.quantity);
  title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(title.front())));
  const bool lacks_period = (x == "phase" || y == "phase") && !(period > 0.0);
  if (!lacks_period && add_residual_plot(report, over, title, value, views, &ResidualView::force, Layout::overlaid,
                                         is_error ? nullptr : &instead))
    return;
  report.add(Facts{title, {{"not drawn", lacks_period ? "a phase needs a period" : "the records do not show it"}}});
}

void add_residual_plots(Report& report, std::span<const ResidualView> views, const sim::DriveDescription& model,
                        double period, Layout layout) {
  const sim::DriveKind kind = model.data.kind;
  const Axis missing{"missing " + effort_name(kind), units_of(kind).effort};
  const auto add = [&](const ResidualCoordinate& over, const std::string& title) {
    add_residual_plot(report, over, title, missing, views, &ResidualView::force, layout);
  };
  add(coordinate_of("speed", kind), "Against speed");
  const ResidualCoordinate position = coordinate_of("position", kind, period);
  if (period > 0.0)
    add(coordinate_of("phase", kind, period), fmt::format("Within one period of {:.4g} mm", position.period));
  add(position, "Along the travel");
  add(coordinate_of("acceleration", kind), "Against acceleration");
  add(coordinate_of("time", kind), "Over time");
  const Axis error{"tachometer error", units_of(kind).speed};
  for (const char* name : {"speed", "acceleration"})
    add_residual_plot(report, coordinate_of(name, kind), fmt::format("Tachometer against {}", name), error, views,
                      &ResidualView::speed, layout);
}

void add_residual_maps(Report& report, std::span<const ResidualView> views, const ResidualCoordinate& across,
                       const ResidualCoordinate& up, sim::DriveKind kind) {
  constexpr std::size_t kColumns = 48, kRows = 32;
  constexpr double kStrongest = 0.98;  // quantile of the magnitudes, so that one cell does not set the colour scale
  std::string title = across.axis.quantity + " and " + up.axis.quantity;
  title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(title.front())));
  std::vector<HeatMap> maps;
  Values sizes;
  for (const ResidualView& view : views) {
    if (view.force.x.empty()) return;
    const Values x = across.of(view.force), y = up.of(view.force);
    HeatMap map;
    map.title = views.size() > 1 ? title + ": " + view.name : title;
    map.value = {"missing " + effort_name(kind), units_of(kind).effort};
    map.x = cells_over(across.axis, x, kColumns, across.period);
    map.y = cells_over(up.axis, y, kRows, 0.0);
    if (map.x.count < 2 || map.y.count < 2) return;
    map.values = means_in(map, x, y, view.force.missing);
    for (const double value : map.values)
      if (std::isfinite(value)) sizes.push_back(std::abs(value));
    maps.push_back(std::move(map));
  }
  const double limit = sizes.empty() ? 0.0 : quantile(sizes, kStrongest);
  if (!(limit > 0.0)) return;
  for (HeatMap& map : maps) {
    map.limit = limit;
    report.add(std::move(map));
  }
}

}  // namespace host
