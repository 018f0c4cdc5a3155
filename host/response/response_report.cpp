#include "host/response/response_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/report/text_format.hpp"

namespace host {

namespace {

using Complex = std::complex<double>;

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
constexpr double kGoodModulus = 0.5;  ///< usual requirement: peak of the sensitivity below 6 dB
constexpr double kPoorModulus = 0.35;
constexpr double kNyquistReach = 2.5;  ///< part of the open loop drawn around -1

double decibels(double value) { return 20.0 * std::log10(std::max(value, std::numeric_limits<double>::min())); }

/// Unwrapped phase in degrees, shifted so that its middle lies between -360 and 0, because lines at the ends may be
/// noise.
std::vector<double> unwrapped(const std::vector<Complex>& values) {
  std::vector<double> phase;
  for (const Complex& value : values) {
    const double next = std::arg(value) * kDegreesPerRadian;
    phase.push_back(phase.empty() ? next : next + 360.0 * std::round((phase.back() - next) / 360.0));
  }
  const double turns = phase.empty() ? 0.0 : 360.0 * std::ceil(phase[phase.size() / 2] / 360.0);
  for (double& one : phase) one -= turns;
  return phase;
}

/// Complex values over frequency with the half width of their 95 % intervals.
struct ResponseCurve {
  std::string name;
  SeriesRole role = SeriesRole::measured;
  SeriesStyle style = SeriesStyle::line_and_points;
  std::vector<double> f_Hz;
  std::vector<Complex> values;
  std::vector<double> half_width = {};
};

ScatterSeries magnitude_of(const ResponseCurve& curve) {
  ScatterSeries series{curve.name, curve.role, curve.style, curve.f_Hz, {}, {}, {}};
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    const double size = std::abs(curve.values[i]);
    series.y.push_back(decibels(size));
    if (curve.half_width.empty()) continue;
    series.lower.push_back(decibels(std::max(size - curve.half_width[i], 0.1 * size)));
    series.upper.push_back(decibels(size + curve.half_width[i]));
  }
  return series;
}

ScatterSeries phase_of(const ResponseCurve& curve) {
  ScatterSeries series{curve.name, curve.role, curve.style, curve.f_Hz, unwrapped(curve.values), {}, {}};
  for (std::size_t i = 0; i < curve.half_width.size(); ++i) {
    const double reach = std::atan2(curve.half_width[i], std::abs(curve.values[i])) * kDegreesPerRadian;
    series.lower.push_back(series.y[i] - reach);
    series.upper.push_back(series.y[i] + reach);
  }
  return series;
}

ScatterPlot over_frequency(std::string title, std::string caption, Axis y, std::vector<ScatterSeries> series) {
  ScatterPlot plot;
  plot.title = std::move(title);
  plot.caption = std::move(caption);
  plot.x = {"frequency", "Hz"};
  plot.y = std::move(y);
  plot.series = std::move(series);
  plot.logarithmic_x = true;
  return plot;
}

ResponseCurve plant_curve(const FrequencyResponse& response, Eigen::Index channel, const std::string& name,
                          SeriesRole role) {
  ResponseCurve curve{name, role, SeriesStyle::line_and_points, {}, {}, {}};
  for (const ResponseLine& line : response.lines) {
    curve.f_Hz.push_back(line.f_Hz);
    curve.values.push_back(line.plant(channel));
    curve.half_width.push_back(half_width_95(line, Eigen::Vector2cd::Unit(channel)));
  }
  return curve;
}

ScatterSeries level(const FrequencyResponse& response, const std::string& name, SeriesRole role,
                    double ResponseLine::*value) {
  ScatterSeries series{name, role, SeriesStyle::line, {}, {}, {}, {}};
  for (const ResponseLine& line : response.lines) {
    series.x.push_back(line.f_Hz);
    series.y.push_back(line.*value > 0.0 ? decibels(line.*value) : std::numeric_limits<double>::quiet_NaN());
  }
  return series;
}

ScatterSeries distortion(const std::string& name, SeriesRole role, const std::vector<DistortionLine>& lines) {
  ScatterSeries series{name, role, SeriesStyle::points, {}, {}, {}, {}};
  for (const DistortionLine& line : lines) {
    if (!(line.level > 0.0)) continue;
    series.x.push_back(line.f_Hz);
    series.y.push_back(decibels(line.level));
  }
  return series;
}

void add_plant(Report& report, const AxisResponse& axis, const AxisResponse* before) {
  const FrequencyResponse& response = axis.response;
  report.section("Drive", "From the command in volts to the sensors. Bands: 95 % intervals.");
  for (const Eigen::Index channel : {0, 1}) {
    if (channel == 0 ? !response.has_position : !response.has_speed) continue;
    const std::string name = channel == 0 ? "position" : "speed";
    std::vector<ResponseCurve> curves;
    if (before != nullptr) curves.push_back(plant_curve(before->response, channel, "before", SeriesRole::before));
    const bool is_measured = response.method != FrequencyResponse::Method::model;
    curves.push_back(plant_curve(response, channel, is_measured ? "measured" : "model", SeriesRole::measured));
    if (axis.fit && is_measured) {
      ResponseCurve fitted{"fit", SeriesRole::model, SeriesStyle::line, {}, {}, {}};
      const double low = response.lines.front().f_Hz, high = response.lines.back().f_Hz;
      for (int i = 0; i <= 300; ++i) {
        fitted.f_Hz.push_back(low * std::pow(high / low, i / 300.0));
        fitted.values.push_back(axis.fit->at(fitted.f_Hz.back())(channel));
      }
      curves.push_back(std::move(fitted));
    }
    std::vector<ScatterSeries> magnitudes, phases;
    for (const ResponseCurve& curve : curves) {
      magnitudes.push_back(magnitude_of(curve));
      phases.push_back(phase_of(curve));
    }
    std::string caption;
    if (channel == response.channel()) {
      magnitudes.push_back(level(response, "noise", SeriesRole::floor, &ResponseLine::noise));
      magnitudes.push_back(level(response, "nonlinearity", SeriesRole::residual, &ResponseLine::nonlinearity));
      magnitudes.push_back(distortion("even distortion", SeriesRole::other, response.even));
      magnitudes.push_back(distortion("odd distortion", SeriesRole::before, response.odd));
      std::erase_if(magnitudes, [](const ScatterSeries& series) { return series.x.empty(); });
      caption =
          "Noise: its part of the estimate's uncertainty. Nonlinearity: variation between runs beyond noise (friction, "
          "backlash). Distortion: response at frequencies without excitation, even (friction that falls with speed, "
          "asymmetry) and odd (backlash, stiction, saturation), without noise.";
    }
    report.add(over_frequency(capitalised(name) + ", magnitude", caption,
                              {name, fmt::format("dB {}", plant_unit(response, channel))}, std::move(magnitudes)));
    report.add(over_frequency(capitalised(name) + ", phase", "", {"phase", "degrees"}, std::move(phases)));
  }
  if (response.method == FrequencyResponse::Method::welch)
    report.add(over_frequency("Coherence", "1: the command explains the whole response.", {"coherence", ""}, [&] {
      ScatterSeries series{"coherence", SeriesRole::measured, SeriesStyle::line, {}, {}, {}, {}};
      for (const ResponseLine& line : response.lines) {
        series.x.push_back(line.f_Hz);
        series.y.push_back(line.coherence);
      }
      return std::vector<ScatterSeries>{series};
    }()));
}

std::vector<Complex> sensitivity(const std::vector<Complex>& L) {
  std::vector<Complex> S;
  for (const Complex& value : L) S.push_back(1.0 / (1.0 + value));
  return S;
}

ScatterSeries circle(const std::string& name, SeriesRole role, Complex centre, double radius) {
  ScatterSeries series{name, role, SeriesStyle::points, {}, {}, {}, {}};
  for (int i = 0; i < 360; ++i) {
    const Complex at = centre + std::polar(radius, i / kDegreesPerRadian);
    series.x.push_back(at.real());
    series.y.push_back(at.imag());
  }
  return series;
}

ScatterSeries locus(const OpenLoop& loop, const std::string& name, SeriesRole role) {
  ScatterSeries series{name, role, SeriesStyle::points, {}, {}, {}, {}};
  for (const Complex& value : loop.fine_L)
    if (std::abs(value + 1.0) < kNyquistReach) {
      series.x.push_back(value.real());
      series.y.push_back(value.imag());
    }
  return series;
}

void add_loop(Report& report, const AxisResponse& axis, const AxisResponse* before) {
  const OpenLoop& loop = *axis.loop;
  report.section("Loop", "The drive with the axis's own estimator and feedback, cut at the drive's input.");
  std::vector<ResponseCurve> curves, sensitivities;
  const auto append = [&](const OpenLoop& one, const std::string& name, SeriesRole role) {
    curves.push_back({name, role, SeriesStyle::line, one.fine_f_Hz, one.fine_L, {}});
    sensitivities.push_back({name, role, SeriesStyle::line, one.fine_f_Hz, sensitivity(one.fine_L), {}});
  };
  if (before != nullptr && before->loop) append(*before->loop, "before", SeriesRole::before);
  append(loop, before != nullptr ? "after" : "loop", SeriesRole::after);
  if (axis.response.method != FrequencyResponse::Method::model)
    curves.push_back({"measured lines", SeriesRole::measured, SeriesStyle::points, loop.f_Hz, loop.L, loop.half_width});
  std::vector<ScatterSeries> magnitudes, phases, peaks;
  for (const ResponseCurve& curve : curves) {
    magnitudes.push_back(magnitude_of(curve));
    phases.push_back(phase_of(curve));
  }
  for (const ResponseCurve& curve : sensitivities) peaks.push_back(magnitude_of(curve));
  report.add(
      over_frequency("Open loop, magnitude", "It crosses 0 dB at the crossover.", {"open loop", "dB"}, magnitudes));
  report.add(over_frequency("Open loop, phase", "Its distance from -180 degrees at the crossover is the phase margin.",
                            {"phase", "degrees"}, phases));
  report.add(over_frequency(
      "Sensitivity",
      "Gain from disturbance to error: below 0 dB the loop reduces the disturbance, above it amplifies it.",
      {"sensitivity", "dB"}, peaks));
  ScatterPlot nyquist;
  nyquist.title = "Nyquist plot";
  nyquist.caption = "The radius of the grey circle about -1 is the modulus margin: the loop touches it.";
  nyquist.x = {"real part", ""};
  nyquist.y = {"imaginary part", ""};
  nyquist.equal_scales = true;
  if (axis.margins && axis.margins->modulus)
    nyquist.series.push_back(circle("modulus margin", SeriesRole::floor, -1.0, axis.margins->modulus->value));
  nyquist.series.push_back(circle("unit circle", SeriesRole::other, 0.0, 1.0));
  if (before != nullptr && before->loop) nyquist.series.push_back(locus(*before->loop, "before", SeriesRole::before));
  nyquist.series.push_back(locus(loop, before != nullptr ? "after" : "loop", SeriesRole::after));
  nyquist.series.push_back({"-1", SeriesRole::residual, SeriesStyle::points, {-1.0}, {0.0}, {}, {}});
  report.add(std::move(nyquist));
}

std::string with_interval(const std::optional<Interval95>& value, int digits = 3) {
  if (!value) return "–";
  const std::string text = format_value(value->value, digits), low = format_value(value->ci95[0], digits),
                    high = format_value(value->ci95[1], digits);
  return low == high ? text : fmt::format("{} ({} to {})", text, low, high);  // a model has no interval
}

Table margins_table(const AxisResponse& axis, const AxisResponse* before) {
  Table table;
  table.title = "Margins";
  table.caption = "In brackets: 95 % intervals.";
  table.headings = {"margin", "value"};
  if (before != nullptr) table.headings = {"margin", "before", "after"};
  const auto row = [&](const std::string& name, std::optional<Interval95> LoopMargins::*which) {
    std::vector<std::string> cells{name};
    if (before != nullptr) cells.push_back(before->margins ? with_interval((*before->margins).*which) : "–");
    cells.push_back(with_interval((*axis.margins).*which));
    table.rows.push_back(std::move(cells));
  };
  row("modulus margin, 1/max|S|", &LoopMargins::modulus);
  row("phase margin, degrees", &LoopMargins::phase_deg);
  row("gain margin, dB", &LoopMargins::gain_dB);
  row("crossover, Hz", &LoopMargins::crossover_Hz);
  return table;
}

Table resonances_table(const PlantFit& fit) {
  Table table;
  table.title = "Resonances";
  table.headings = {"frequency, Hz", "damping", "part in position", "part in speed"};
  for (const Resonance& mode : fit.resonances)
    table.rows.push_back({with_interval(mode.f_Hz, 4), with_interval(mode.damping), format_value(mode.position_share),
                          format_value(mode.speed_share)});
  return table;
}

/// Whether `axis` is a new measurement, not the same measurement with another controller.
bool is_measured_again(const AxisResponse& axis, const AxisResponse& before) {
  const auto& a = axis.response.lines;
  const auto& b = before.response.lines;
  return !b.empty() && (a.size() != b.size() || a.front().plant != b.front().plant);
}

Verdict verdict_of(const AxisResponse& axis) {
  Verdict verdict;
  if (!axis.margins) {
    verdict.label = "measured";
    verdict.headline =
        fmt::format("The drive's response at {} frequencies from {} to {} Hz.", axis.response.lines.size(),
                    format_value(axis.response.lines.front().f_Hz), format_value(axis.response.lines.back().f_Hz));
    verdict.sentences = {"Margins need a controller: give --model MODEL, or measure an axis of a board."};
  } else if (!axis.margins->is_stable) {
    verdict.tone = Tone::bad;
    verdict.label = "unstable";
    verdict.headline = "The measured drive would oscillate with this controller.";
  } else {
    const double modulus = axis.margins->modulus ? axis.margins->modulus->value : 1.0;
    verdict.tone = modulus >= kGoodModulus ? Tone::good : modulus >= kPoorModulus ? Tone::attention : Tone::bad;
    verdict.label = modulus >= kGoodModulus ? "robust" : modulus >= kPoorModulus ? "tight" : "close to oscillation";
    verdict.headline = fmt::format("Modulus margin {}", with_interval(axis.margins->modulus));
    if (axis.margins->phase_deg)
      verdict.headline += fmt::format(", phase margin {} degrees", with_interval(axis.margins->phase_deg));
    if (axis.margins->gain_dB)
      verdict.headline += fmt::format(", gain margin {} dB", with_interval(axis.margins->gain_dB));
    if (axis.margins->crossover_Hz)
      verdict.headline += fmt::format(" at a crossover of {} Hz", with_interval(axis.margins->crossover_Hz));
    verdict.headline += ".";
    verdict.sentences.push_back(fmt::format("The loop is nearest to -1 at {} Hz; a usual target is 0.5.",
                                            format_value(axis.margins->modulus_at_Hz)));
  }
  if (axis.fit)
    for (const Resonance& mode : axis.fit->resonances)
      verdict.sentences.push_back(fmt::format("Resonance at {} Hz, damping {}.", with_interval(mode.f_Hz, 4),
                                              format_value(mode.damping.value)));
  for (const std::string& warning : axis.response.warnings) verdict.sentences.push_back(capitalised(warning) + ".");
  return verdict;
}

}  // namespace

Report response_report(const AxisResponse& axis, const std::string& subtitle, const AxisResponse* before) {
  Report report("Frequency response", subtitle);
  report.verdict(verdict_of(axis));
  if (axis.margins || (axis.fit && !axis.fit->resonances.empty())) report.section("Figures");
  if (axis.margins) report.add(margins_table(axis, before));
  if (axis.fit && !axis.fit->resonances.empty()) report.add(resonances_table(*axis.fit));
  if (axis.loop) add_loop(report, axis, before);
  add_plant(report, axis, before != nullptr && is_measured_again(axis, *before) ? before : nullptr);
  report.section("Measurement");
  const FrequencyResponse& response = axis.response;
  const bool is_periodic = response.method == FrequencyResponse::Method::periodic;
  Facts facts;
  if (response.method == FrequencyResponse::Method::model) {
    facts.items = {{"method", "predicted by the model, not measured"}};
    report.add(std::move(facts));
    return report;
  }
  facts.items = {{"method", is_periodic ? "odd random-phase multisine, robust method" : "Welch"},
                 {"against", response.is_indirect ? "the excitation (closed loop)" : "the command"},
                 {is_periodic ? "realisations" : "stretches",
                  std::to_string(is_periodic ? response.realisations : response.periods)},
                 {"frequencies", std::to_string(response.lines.size())},
                 {"sample period", fmt::format("{:g} ms", 1e3 * response.sample_period_s)}};
  if (is_periodic) facts.items.emplace_back("periods of each", std::to_string(response.periods));
  if (axis.fit) {
    facts.items.emplace_back(
        "delay beyond the hold",
        with_interval(Interval95{1e3 * axis.fit->delay_s.value,
                                 {1e3 * axis.fit->delay_s.ci95[0], 1e3 * axis.fit->delay_s.ci95[1]}}) +
            " ms");
    if (axis.fit->lag_s.value > 0.0)
      facts.items.emplace_back("lag of the current loop",
                               fmt::format("{} ms: a bandwidth of {:.3g} Hz", format_value(1e3 * axis.fit->lag_s.value),
                                           0.5 / (std::numbers::pi * axis.fit->lag_s.value)));
    facts.items.emplace_back("misfit of the fit", format_value(axis.fit->misfit) + " standard deviations");
  }
  report.add(std::move(facts));
  return report;
}

std::string margins_text(const AxisResponse& axis, const AxisResponse* before, const Terminal& terminal) {
  return axis.margins ? terminal_table(margins_table(axis, before), terminal) : "";
}

std::string response_text(const AxisResponse& axis, const Terminal& terminal) {
  std::string text = terminal_verdict(verdict_of(axis), terminal);
  if (axis.margins) text += "\n" + margins_text(axis, nullptr, terminal);
  if (axis.fit && !axis.fit->resonances.empty()) text += "\n" + terminal_table(resonances_table(*axis.fit), terminal);
  return text;
}

}  // namespace host
