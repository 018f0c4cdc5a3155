#include "host/report/polar_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "host/report/series_colour.hpp"
#include "host/report/text_format.hpp"

namespace host::html {

namespace {

constexpr double kSize = 600.0, kCentre = kSize / 2.0;  // size of the picture, in its own units
constexpr double kCircle = 160.0, kRing = 22.0;         // radius of the nominal circle; distance of two rings
constexpr int kMostRings = 4;
constexpr std::size_t kMostPoints = 4000;

double largest_um(const PolarPlot& plot) {
  double largest = 0.0;
  for (const PolarTrace& trace : plot.traces)
    for (const double value : trace.deviation_um)
      if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  return largest;
}

/// A ring distance of 1, 2 or 5 times a power of ten, with which the largest deviation covers at most kMostRings rings.
double ring_um(double largest) {
  if (!(largest > 0.0)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(largest / kMostRings)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power * kMostRings >= largest) return step * power;
  return 10.0 * power;
}

std::string rings(double step_um, int count) {
  std::string svg;
  const auto out = std::back_inserter(svg);
  for (int ring = -count; ring <= count; ++ring)
    fmt::format_to(out, "<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", ring == 0 ? "nominal" : "ring",
                   kCentre, kCentre, kCircle + kRing * ring);
  const double reach = kCircle + kRing * (count + 0.6);
  for (const auto& [name, x, y] :
       {std::tuple("+X", 1, 0), std::tuple("+Y", 0, 1), std::tuple("−X", -1, 0), std::tuple("−Y", 0, -1)}) {
    fmt::format_to(out, "<line class=\"ring\" x1=\"{0}\" y1=\"{0}\" x2=\"{1}\" y2=\"{2}\"/>", kCentre,
                   kCentre + reach * x, kCentre - reach * y);
    fmt::format_to(out, "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", kCentre + (reach + 14.0) * x,
                   kCentre - (reach + 14.0) * y + 4.0, name);
  }
  // The outermost, the nominal and the innermost ring have labels away from the axes.
  const double along = std::numbers::sqrt2 / 2.0;
  for (const int ring : {-count, 0, count}) {
    const double radius = kCircle + kRing * ring;
    fmt::format_to(out, "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", kCentre + radius * along + 3.0,
                   kCentre - radius * along - 3.0,
                   ring == 0 ? std::string("0") : fmt::format("{}{:g} µm", ring < 0 ? "−" : "+", count * step_um));
  }
  return svg;
}

/// Lines of one colour differ by their dashes: drawn and left out, in units of the picture; the first is solid.
constexpr std::array<std::array<int, 2>, 3> kDashes = {{{1, 0}, {6, 4}, {2, 3}}};

const std::array<int, 2>& dash_of(const PolarPlot& plot, std::size_t at) {
  const auto before = std::count_if(plot.traces.begin(), plot.traces.begin() + static_cast<std::ptrdiff_t>(at),
                                    [&](const PolarTrace& one) { return one.role == plot.traces[at].role; });
  return kDashes[static_cast<std::size_t>(before) % kDashes.size()];
}

std::string swatch(SeriesRole role, const std::array<int, 2>& dash) {
  return fmt::format(
      "<i class=\"swatch\" style=\"background:repeating-linear-gradient(90deg,{0} 0 {1}px,transparent {1}px "
      "{2}px)\"></i>",
      series_colour(role), dash[0], dash[0] + dash[1]);
}

std::string trace_line(const PolarTrace& trace, double step_um, const std::array<int, 2>& dash) {
  std::string path;
  const std::size_t stride = 1 + trace.angle_rad.size() / kMostPoints;
  bool pen_down = false;
  for (std::size_t k = 0; k < trace.angle_rad.size(); k += stride) {
    const double radius = kCircle + kRing * trace.deviation_um[k] / step_um;
    if (!std::isfinite(radius) || !std::isfinite(trace.angle_rad[k])) {
      pen_down = false;
      continue;
    }
    fmt::format_to(std::back_inserter(path), "{}{:.1f} {:.1f}", pen_down ? "L" : "M",
                   kCentre + radius * std::cos(trace.angle_rad[k]), kCentre - radius * std::sin(trace.angle_rad[k]));
    pen_down = true;
  }
  return fmt::format("<path class=\"trace\" style=\"stroke:{};stroke-dasharray:{} {}\" d=\"{}\"/>\n",
                     series_colour(trace.role), dash[0], dash[1], path);
}

/// "before: −12.3 to 4.1 µm".
std::string span_of(const PolarTrace& trace) {
  if (trace.deviation_um.empty()) return trace.name;
  const auto [lowest, highest] = std::ranges::minmax(trace.deviation_um);
  return fmt::format("{}: {} to {} µm", trace.name, format_value(lowest), format_value(highest));
}

}  // namespace

std::string polar_plot(const PolarPlot& plot) {
  const double largest = largest_um(plot), step_um = ring_um(largest);
  const int count = std::max(1, static_cast<int>(std::ceil(largest / step_um)));
  const double magnification = (kRing / step_um) / (kCircle / (1e3 * plot.radius_mm));
  std::string legend, spoken, traces;
  for (std::size_t i = 0; i < plot.traces.size(); ++i) {
    const PolarTrace& trace = plot.traces[i];
    const std::string text = escape_html(span_of(trace));
    legend += fmt::format("<span>{}{}</span>", swatch(trace.role, dash_of(plot, i)), text);
    spoken += "; " + text;
    traces += trace_line(trace, step_um, dash_of(plot, i));
  }
  return fmt::format(
      "<figure class=\"polar half\">\n<figcaption><strong>{}</strong><span>{} Radial deviations drawn {} times larger "
      "than the circle of {:g} mm; rings are {:g} µm apart.</span></figcaption>\n<div class=\"legend\">{}</div>\n"
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}{}\">\n{}{}</svg>\n</figure>\n",
      escape_html(plot.title), escape_html(plot.caption), format_value(magnification), plot.radius_mm, step_um, legend,
      kSize, kSize, escape_html(plot.title), spoken, rings(step_um, count), traces);
}

}  // namespace host::html
