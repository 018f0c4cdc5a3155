#include "host/diagnose/found_effect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "host/fit/parameter_covariance.hpp"
#include "host/record/drive_units.hpp"
#include "host/report/text_format.hpp"
#include "host/statistics.hpp"
#include "sim/catalogue.hpp"
#include "sim/harmonic.hpp"

namespace host {

namespace {

using Values = std::vector<double>;
using Curves = std::vector<ScatterSeries>;

const char* residual_unit(const FoundEffect& effect) {
  return effect.of_speed_channel ? units_of(effect.drive).speed : units_of(effect.drive).effort;
}

sim::DriveDescription without_kind(sim::DriveDescription model, std::string_view kind) {
  std::erase_if(model.effects, [kind](const sim::EffectEntry& entry) { return entry.kind == kind; });
  return model;
}

Values difference(const Values& a, const Values& b) {
  Values result(a.size());
  std::ranges::transform(a, b, result.begin(), std::minus<>());
  return result;
}

/// The squared value, 0 for a sample without one.
double square_of(double value) { return std::isfinite(value) ? value * value : 0.0; }

double sum_of_finite_squares(const Values& values) {
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [](double sum, double value) { return sum + square_of(value); });
}

/// Share of the squared trace that its means over the coordinate explain, 0..1.
double carried_share(const ResidualEffort& samples, const Values& trace, const ResidualCoordinate& over) {
  double carried = 0.0;
  for (const ScatterSeries& curve : direction_curves(samples, trace, over))
    for (std::size_t k = 0; k < curve.y.size(); ++k)
      if (std::isfinite(curve.y[k])) carried += curve.samples[k] * curve.y[k] * curve.y[k];
  return carried / sum_of_finite_squares(trace);
}

/// The period over which a ripple is drawn: its own, but that of its strongest order if this is so fine that the whole
/// period would have too few bins for each ripple. 0 if there is none.
double drawn_period(const sim::EffectEntry& entry) {
  constexpr double kFinestOrder = 4.0;  // some 48 bins are a dozen for each ripple
  if (!entry.has("period")) return 0.0;
  const std::vector<sim::HarmonicTerm> terms =
      entry.has_any("cosine") ? sim::harmonics_of(entry) : std::vector<sim::HarmonicTerm>{};
  const auto strongest = std::ranges::max_element(
      terms, {}, [](const sim::HarmonicTerm& term) { return std::hypot(term.cosine, term.sine); });
  const bool is_fine = strongest != terms.end() && strongest->order > kFinestOrder;
  return entry.at("period") / (is_fine ? strongest->order : 1.0);
}

/// Coordinates over which the trace may show: those of the catalogue, with the period of a ripple; for a free curve its
/// own coordinate.
std::vector<ResidualCoordinate> coordinates_of(const sim::EffectInfo& info, const sim::EffectEntry& entry,
                                               const ResidualEffort& samples, sim::DriveKind kind) {
  std::vector<std::string_view> names(info.along.begin(), info.along.end());
  if (info.curve) names.push_back(entry.over);
  std::vector<ResidualCoordinate> all;
  const double period = drawn_period(entry);
  for (std::string_view name : names) {
    if (name == "friction_along_position") name = "position";
    if (name == "friction_over_time") name = "time";
    if (name == "frequency") continue;  // no coordinate of a sample
    ResidualCoordinate over = coordinate_of(name, kind, period);
    if ((samples.*over.along).size() != samples.w.size()) continue;
    if (over.period > 0.0) {
      const auto [low, high] = std::ranges::minmax_element(samples.x);
      over.folded = *high - *low > 2.0 * period;
      if (over.folded) over.axis.quantity = fmt::format("position within {:.4g} mm", over.period);
    }
    all.push_back(std::move(over));
  }
  if (all.empty()) all.push_back(coordinate_of("speed", kind));
  return all;
}

/// Whether a sample blurs a ripple. A sample is an average over 5 ms. It is blurred if the axis passes more than an
/// eighth of the shortest period in this time (at an eighth, 97 % of the amplitude remain).
std::vector<bool> blurred_samples(const FoundEffect& effect, const sim::DriveDescription& model) {
  constexpr double kMostPeriods = 0.125;
  constexpr std::ptrdiff_t kFewest = 200;
  const sim::EffectEntry& entry = *model.find(effect.kind);
  const double period = entry.has_any("cosine") ? sim::Harmonics(entry).finest_period() : entry.at("period");
  std::vector<bool> blurred;
  for (const double w : effect.without.w)
    blurred.push_back(std::abs(w) * model.data.lead * effect.without.period_s > kMostPeriods * period);
  if (std::ranges::count(blurred, false) < kFewest) blurred.assign(blurred.size(), false);
  return blurred;
}

/// Fills the trace, with NaN for samples without a value of the coordinate.
void trace_of(FoundEffect& effect, const sim::DriveDescription& model, const RecordSet& shown) {
  const sim::DriveDescription less = without_kind(model, effect.kind);
  std::vector<ResidualEffort> both;
  if (effect.of_speed_channel)
    both = {residual_of_speed_channel(less, shown), residual_of_speed_channel(model, shown)};
  else
    both = residuals_on({&less, &model}, shown);
  effect.trace = difference(both.front().missing, both.back().missing);
  effect.without = std::move(both.front());
  const std::vector<bool> blurred = effect.over.folded ? blurred_samples(effect, model) : std::vector<bool>{};
  for (std::size_t k = 0; k < effect.trace.size(); ++k)
    if ((effect.only_record && effect.without.record[k] != *effect.only_record) || (!blurred.empty() && blurred[k]))
      effect.trace[k] = effect.without.missing[k] = std::nan("");
}

/// The record in which the trace is strongest.
std::size_t strongest_record(const FoundEffect& effect) {
  Values squares(1 + std::ranges::max(effect.without.record));
  for (std::size_t k = 0; k < effect.trace.size(); ++k) squares[effect.without.record[k]] += square_of(effect.trace[k]);
  return static_cast<std::size_t>(std::ranges::max_element(squares) - squares.begin());
}

struct Peak {
  std::size_t curve = 0, bin = 0;
  double mean = 0.0;
};

Peak peak_of(const Curves& curves) {
  Peak peak;
  for (std::size_t c = 0; c < curves.size(); ++c)
    for (std::size_t k = 0; k < curves[c].y.size(); ++k)
      if (std::abs(curves[c].y[k]) > std::abs(peak.mean)) peak = {c, k, curves[c].y[k]};
  return peak;
}

/// Lowest and highest value of a curve. Of one with counts of samples, without the hundredth of the samples at either
/// end: a bin of few samples may be far from all others.
std::pair<double, double> usual_range(const ScatterSeries& series) {
  constexpr double kLeftOut = 0.01;
  std::vector<std::pair<double, double>> values;  // with their weights
  double whole = 0.0;
  for (std::size_t k = 0; k < series.y.size(); ++k) {
    if (!std::isfinite(series.y[k])) continue;
    values.emplace_back(series.y[k], series.samples.size() == series.y.size() ? series.samples[k] : 1.0);
    whole += values.back().second;
  }
  if (values.empty()) return {0.0, 0.0};
  std::ranges::sort(values);
  if (series.samples.empty()) return {values.front().first, values.back().first};
  const auto within = [&](auto begin, auto end) {
    for (double sum = 0.0; begin != end; ++begin)
      if ((sum += begin->second) > kLeftOut * whole) return begin->first;
    return 0.0;
  };
  return {within(values.begin(), values.end()), within(values.rbegin(), values.rend())};
}

/// The largest encoder error over one period of the travel.
double largest_encoder_error(const sim::DriveDescription& model, double period) {
  constexpr int kPlaces = 200;
  const sim::Drive drive(model);
  double largest = 0.0;
  for (int k = 0; k < kPlaces; ++k) largest = std::max(largest, std::abs(drive.encoder_error_at(period * k / kPlaces)));
  return largest;
}

/// The parameter that describes the size of an effect better than a torque does; empty if there is none.
std::string_view main_parameter(const sim::EffectInfo& info) {
  const bool acts_elsewhere =
      info.stage == sim::Stage::command || info.stage == sim::Stage::motor || info.stage == sim::Stage::mechanics;
  return acts_elsewhere && !info.periodic ? info.parameters.front().id : std::string_view{};
}

/// A unit in which the value of a parameter is easy to read, and the factor to it. The key of the parameter ends with
/// its unit, after the last "_".
struct ShownUnit {
  std::string name;
  double factor = 1.0;
};

ShownUnit shown_unit(std::string_view key, double value) {
  constexpr double kSmall_s = 0.1, kSmall_mm = 1.0;
  const std::string unit(key.substr(key.rfind('_') + 1));
  if (unit == "s" && value < kSmall_s) return {"ms", 1e3};
  if (unit == "mm" && value < kSmall_mm) return {"µm", 1e3};
  if (unit == "m") return value < 1e-3 * kSmall_mm ? ShownUnit{"µm", 1e6} : ShownUnit{"mm", 1e3};
  return {unit};
}

/// Points of a view that is not of means over a coordinate.
std::optional<EffectPoints> points_of(const sim::DriveDescription& model, std::string_view kind, sim::View view,
                                      const RecordSet& shown) {
  const sim::DriveDescription less = without_kind(model, kind);
  if (view == sim::View::starts) return starts_of(less, model, shown);
  if (view == sim::View::moment) return moment_of(less, model, shown);
  return {};
}

/// FoundEffect::size of a model. The trace is read in the bin at `peak`.
double size_in(const FoundEffect& effect, const sim::DriveDescription& model, const RecordSet& shown,
               const Peak& peak) {
  const sim::EffectInfo& info = *sim::find_effect(effect.kind);
  if (const std::string id(main_parameter(info)); !id.empty()) {
    const double value = std::abs(model.find(effect.kind)->at(id));
    return shown_unit(info.parameter(id)->key(effect.drive), value).factor * value;
  }
  if (info.stage == sim::Stage::encoder)
    return 1e3 * travel_in_mm(effect.drive) * largest_encoder_error(model, model.find(effect.kind)->at("period"));
  if (effect.view == sim::View::starts) {
    const auto points = points_of(model, effect.kind, effect.view, shown);
    return points ? std::ranges::max(points->part) : 0.0;
  }
  FoundEffect other = effect;
  trace_of(other, model, shown);
  return std::abs(direction_curves(other.without, other.trace, other.over)[peak.curve].y[peak.bin]);
}

/// 95 % interval of the size, from its derivatives with respect to the effect's parameters and their covariance (delta
/// method).
std::optional<std::array<double, 2>> interval_of(const FoundEffect& effect, const sim::DriveDescription& model,
                                                 const RecordSet& shown, const RecordSet& training, const Peak& peak) {
  constexpr double kMostStep = 0.05;  // relative; the derivative must hold near the fitted value
  const auto [vector, values, covariance] = covariance_of(model, training);
  if (covariance.size() == 0) return {};
  Eigen::VectorXd slopes = Eigen::VectorXd::Zero(values.size());
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    const FreeParameter& free = vector.parameters()[static_cast<std::size_t>(k)];
    if (model.effects[free.effect].kind != effect.kind) continue;
    const double magnitude = values(k) != 0.0 ? std::abs(values(k)) : free.scale;
    const double step = std::min(std::sqrt(std::max(0.0, covariance(k, k))), kMostStep * magnitude);
    if (!(step > 0.0)) continue;
    Eigen::VectorXd moved = values;
    moved(k) += moved(k) + step > free.upper ? -step : step;
    sim::DriveDescription changed = model;
    vector.write(moved, changed);
    slopes(k) = (size_in(effect, changed, shown, peak) - effect.size) / (moved(k) - values(k));
  }
  const double deviation = std::sqrt(std::max(0.0, slopes.dot(covariance * slopes)));
  if (!std::isfinite(deviation) || deviation == 0.0) return {};
  const double reach = kNormal95 * deviation;
  return std::array{std::max(0.0, effect.size - reach), effect.size + reach};
}

double mean_coulomb(const sim::DriveDescription& model) {
  const sim::Drive drive(model);
  double sum = 0.0;
  for (std::size_t side = 0; side < drive.friction.size(); ++side)
    sum += drive.friction[side].coulomb * drive.direction_factor[side].level;
  return sum / static_cast<double>(drive.friction.size());
}

std::optional<FoundEffect> found_effect(const sim::DriveDescription& model, const sim::EffectEntry& entry,
                                        const RecordSet& shown, const RecordSet& training) {
  const sim::EffectInfo& info = *sim::find_effect(entry.kind);
  FoundEffect effect;
  effect.kind = entry.kind;
  effect.drive = model.data.kind;
  effect.of_speed_channel = info.stage == sim::Stage::tachometer;
  trace_of(effect, model, shown);
  if (!(sum_of_finite_squares(effect.trace) > 0.0)) return {};
  double most = -1.0;
  for (ResidualCoordinate& over : coordinates_of(info, entry, effect.without, model.data.kind)) {
    const double share = carried_share(effect.without, effect.trace, over);
    if (share <= most) continue;
    most = share;
    effect.over = std::move(over);
  }
  if (effect.over.along == &ResidualEffort::t_s) effect.only_record = strongest_record(effect);
  if (effect.only_record || effect.over.folded) trace_of(effect, model, shown);
  if (effect.over.folded) most = carried_share(effect.without, effect.trace, effect.over);  // of unblurred samples
  constexpr double kLeastCarried = 0.4;
  const bool depends_on_none = info.view == sim::View::curve && most < kLeastCarried && !effect.over.folded;
  effect.view = depends_on_none ? sim::View::moment : info.view;
  effect.points = points_of(model, entry.kind, effect.view, shown);
  if (effect.view == sim::View::starts && !effect.points) {
    effect.view = sim::View::moment;
    effect.points = points_of(model, entry.kind, effect.view, shown);
  }
  if (!effect.points) effect.view = sim::View::curve;
  const Peak peak = peak_of(direction_curves(effect.without, effect.trace, effect.over));
  effect.unit = info.stage == sim::Stage::encoder ? "µm" : residual_unit(effect);
  if (const std::string id(main_parameter(info)); !id.empty())
    effect.unit = shown_unit(info.parameter(id)->key(effect.drive), std::abs(entry.at(id))).name;
  effect.size = size_in(effect, model, shown, peak);
  effect.ci95 = interval_of(effect, model, shown, training, peak);
  const double friction = mean_coulomb(model);
  const bool acts_on_shaft = info.stage == sim::Stage::load || info.stage == sim::Stage::friction;
  if (acts_on_shaft && friction > 0.0) effect.share_of_friction = effect.size / friction;
  return effect;
}

}  // namespace

std::vector<FoundEffect> found_effects(const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                                       const PreparedSets& sets) {
  const RecordSet all = together(sets.training, sets.validation);
  std::vector<FoundEffect> found;
  for (const std::string& kind : kinds)
    if (const sim::EffectEntry* entry = model.find(kind))
      if (std::optional<FoundEffect> effect = found_effect(model, *entry, all, sets.training))
        found.push_back(*std::move(effect));
  return found;
}

std::string size_in_words(const FoundEffect& effect) {
  std::string words =
      fmt::format("{}: {} {}", sim::find_effect(effect.kind)->title, format_value(effect.size), effect.unit);
  if (effect.ci95) words += fmt::format(" [{}, {}]", format_value((*effect.ci95)[0]), format_value((*effect.ci95)[1]));
  if (effect.share_of_friction) words += fmt::format(", {:.0f} % of the friction", 100.0 * *effect.share_of_friction);
  return words;
}

void append_curves(const ResidualCoordinate& over, const ResidualEffort& residual, const std::vector<double>& part,
                   ScatterPlot& plot) {
  plot.x = over.axis;
  plot.logarithmic_x = over.logarithmic;
  for (ScatterSeries& curve : direction_curves(residual, residual.missing, over)) {
    curve.style = SeriesStyle::points;
    if (!curve.x.empty()) plot.series.push_back(std::move(curve));
  }
  for (ScatterSeries& curve : direction_curves(residual, part, over)) {
    if (curve.x.empty()) continue;
    curve.style = SeriesStyle::line;
    curve.role = SeriesRole::model;
    curve.dashed = curve.name == "backward";
    curve.name = "effect, " + curve.name;
    curve.lower.clear();
    curve.upper.clear();
    curve.samples.clear();
    plot.series.push_back(std::move(curve));
  }
}

double explained_share(const FoundEffect& effect) {
  if (effect.points) return effect.points->explained_share();
  const Curves all = direction_curves(effect.without, effect.without.missing, effect.over),
               parts = direction_curves(effect.without, effect.trace, effect.over);
  double whole = 0.0, left = 0.0;
  for (std::size_t c = 0; c < all.size(); ++c)
    for (std::size_t k = 0; k < std::min(all[c].y.size(), parts[c].y.size()); ++k) {
      whole += all[c].samples[k] * square_of(all[c].y[k]);
      left += all[c].samples[k] * square_of(all[c].y[k] - parts[c].y[k]);
    }
  return whole > 0.0 ? 1.0 - left / whole : 0.0;
}

namespace {

/// Removes the bands of curves whose bands are mostly so wide that they hide the means. Returns whether bands remain.
bool keep_narrow_bands(ScatterPlot& plot) {
  constexpr double kMostOfThePlot = 0.6;
  bool remain = false;
  for (ScatterSeries& series : plot.series) {
    Values widths = difference(series.upper, series.lower);
    std::erase_if(widths, [](double width) { return !std::isfinite(width); });
    if (widths.empty()) continue;
    if (plot.y_range && median(widths) > kMostOfThePlot * (plot.y_range->second - plot.y_range->first)) {
      series.lower.clear();
      series.upper.clear();
    } else {
      remain = true;
    }
  }
  return remain;
}

}  // namespace

ScatterPlot effect_plot(const FoundEffect& effect) {
  ScatterPlot plot;
  plot.title = size_in_words(effect);
  plot.large = true;
  plot.y = {effect.of_speed_channel                  ? "speed residual"
            : effect.drive == sim::DriveKind::rotary ? "torque residual"
                                                     : "force residual",
            residual_unit(effect)};
  if (effect.points)
    append_points(*effect.points, plot);
  else
    append_curves(effect.over, effect.without, effect.trace, plot);
  show_means(plot);
  const bool has_bands = keep_narrow_bands(plot);
  plot.caption = fmt::format(
      "{} Points: residual of the model without the effect{}. Lines: contribution of the fitted effect, which explains "
      "{:.0f} % of the squares of these points.",
      effect.points ? effect.points->caption : "Training and validation data.",
      !effect.points && has_bands ? ", with the band that holds 80 % of the samples" : "",
      100.0 * explained_share(effect));
  return plot;
}

void show_means(ScatterPlot& plot) {
  constexpr double kMargin = 0.25;
  double low = 0.0, high = 0.0;
  for (const ScatterSeries& series : plot.series) {
    const auto [least, most] = usual_range(series);
    low = std::min(low, least);
    high = std::max(high, most);
  }
  const double margin = kMargin * (high - low);
  if (margin > 0.0) plot.y_range = {low - margin, high + margin};
}

}  // namespace host
