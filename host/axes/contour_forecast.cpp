#include "host/axes/contour_forecast.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "host/fourier.hpp"

namespace host {

namespace {

using Complex = std::complex<double>;

constexpr double kSteady_s = 0.3, kRest_s = 0.7;
constexpr double kHighest_Hz = 150.0;  ///< a jerk-limited motion has no significant content above it
constexpr double kTelling_um = 0.1;

/// Speeds along a line from rest to rest, sample by sample, mm/s.
std::vector<double> line_speeds(double feed, const ReferenceLimits& limits, double period_s) {
  double ramp_s = limits.acceleration / limits.jerk;  // time in which the acceleration builds up
  double level_s = feed / limits.acceleration - ramp_s;
  if (level_s < 0.0) {
    ramp_s = std::sqrt(feed / limits.jerk);
    level_s = 0.0;
  }
  const double up_s = 2.0 * ramp_s + level_s, peak = feed / (ramp_s + level_s);
  const auto speed_at = [&](double t) {  // during the acceleration
    if (t <= 0.0) return 0.0;
    if (t >= up_s) return feed;
    const double from_end = std::min(t, up_s - t), ramp = std::min(from_end, ramp_s);
    const double gained = peak * (0.5 * ramp * ramp / ramp_s + (from_end - ramp));
    return t <= 0.5 * up_s ? gained : feed - gained;
  };
  const auto count = static_cast<std::size_t>((2.0 * up_s + kSteady_s + kRest_s) / period_s);
  std::vector<double> speeds(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) * period_s;
    speeds[k] = speed_at(t) - speed_at(t - up_s - kSteady_s);
  }
  return speeds;
}

/// Following error divided by the speed of the reference, s.
Complex lag(const ServoAxis& axis, double f_Hz) {
  const double period_s = axis.plant.sample_period_s;
  const Complex step = 1.0 - std::polar(1.0, -2.0 * std::numbers::pi * f_Hz * period_s);
  return period_s * (1.0 - following(axis, f_Hz)) / step;
}

double line_45_um(const ServoAxis& x, const ServoAxis& y, double feed_mm_s, const ReferenceLimits& limits) {
  const double period_s = x.plant.sample_period_s;
  const std::vector<double> speeds = line_speeds(feed_mm_s, limits, period_s);
  const auto count = static_cast<double>(speeds.size());
  std::vector<Complex> error = spectrum_of(speeds);
  error.resize(std::min(error.size(), static_cast<std::size_t>(kHighest_Hz * count * period_s)));
  for (std::size_t l = 0; l < error.size(); ++l) {
    const double f_Hz = std::max(static_cast<double>(l), 0.02) / (count * period_s);
    error[l] *= 0.5 * (lag(x, f_Hz) - lag(y, f_Hz)) / count;
  }
  double most = 0.0;
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    const Complex turn = std::polar(1.0, 2.0 * std::numbers::pi * static_cast<double>(k) / count);
    Complex phase = 1.0;
    double sum = error[0].real();
    for (std::size_t l = 1; l < error.size(); ++l) sum += 2.0 * (error[l] * (phase *= turn)).real();
    most = std::max(most, std::abs(sum));
  }
  return 1e3 * most;
}

}  // namespace

Complex following(const ServoAxis& axis, double f_Hz) {
  const Eigen::Vector2cd plant = axis.plant.at(f_Hz);
  return plant(0) * axis.controller.of_reference(f_Hz) / (1.0 + (axis.controller.at(f_Hz) * plant)(0));
}

FeedContour contour_forecast(const ServoAxis& x, const ServoAxis& y, double feed_mm_s, const ReferenceLimits& limits) {
  const double f_Hz = feed_mm_s / (2.0 * std::numbers::pi * kForecastRadius_mm);
  const Complex a = following(x, f_Hz), b = following(y, f_Hz);
  // Half axes p, q of the ellipse (a cos, b sin): p^2 + q^2 = |a|^2 + |b|^2, p q = Re(a b*).
  const double difference = std::norm(a) + std::norm(b) - 2.0 * std::abs((a * std::conj(b)).real());
  return {feed_mm_s, line_45_um(x, y, feed_mm_s, limits),
          1e3 * kForecastRadius_mm * std::sqrt(std::max(0.0, difference))};
}

std::string main_difference(const ServoAxis& x, const ServoAxis& y, double feed_mm_s, const ReferenceLimits& limits) {
  const double now = line_45_um(x, y, feed_mm_s, limits);
  if (now < kTelling_um) return {};
  using Change = void (*)(PlantFit & to, const PlantFit& from);
  const std::pair<const char*, Change> changes[] = {
      {"viscous friction over inertia", [](PlantFit& to, const PlantFit& from) { to.pole = from.pole; }},
      {"dead time or current loop",
       [](PlantFit& to, const PlantFit& from) {
         to.delay_s = from.delay_s;
         to.lag_s = from.lag_s;
       }},
      {"resonance", [](PlantFit& to, const PlantFit& from) { to.resonances = from.resonances; }}};
  double least = 0.5 * now;
  std::string found;
  for (const auto& [name, change] : changes) {
    ServoAxis equal = y;
    change(equal.plant, x.plant);
    const double left = line_45_um(x, equal, feed_mm_s, limits);
    if (left >= least) continue;
    least = left;
    found = name;
  }
  return found;
}

}  // namespace host
