// A report with every kind of block, with data in closed form.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "host/report/report.hpp"

namespace host::sample {

inline constexpr const char* hostile_text = "</script><script>document.title='taken over'</script><!-- \" ' & \xff";

/// A sine of 2 Hz and its residual after a prediction that is 10 % too small, sampled at 1 kHz.
inline TimePlot time_plot(std::size_t samples) {
  TimePlot plot;
  plot.title = "train.csv";
  TimeTrace measured{"measured", SeriesRole::measured, {}};
  TimeTrace predicted{"predicted", SeriesRole::predicted, {}};
  TimeTrace residual{"residual", SeriesRole::residual, {}};
  for (std::size_t k = 0; k < samples; ++k) {
    plot.t_s.push_back(0.001 * static_cast<double>(k));
    const double speed = 30.0 * std::sin(4.0 * std::numbers::pi * plot.t_s.back());
    measured.values.push_back(speed);
    predicted.values.push_back(0.9 * speed);
    residual.values.push_back(0.1 * speed);
  }
  plot.panels = {{"speed", "rad/s", {measured, predicted}}, {"speed error", "rad/s", {residual}}};
  plot.shaded = {{0.5, 0.6}};
  return plot;
}

inline ScatterPlot friction_curve() {
  ScatterSeries points{"measured", SeriesRole::measured, SeriesStyle::points, {}, {}, {}, {}};
  ScatterSeries line{"model", SeriesRole::model, SeriesStyle::line, {}, {}, {}, {}};
  for (int step = -20; step <= 20; ++step) {
    const double speed = 3.0 * step;
    const double torque = step == 0 ? std::nan("") : std::copysign(2.0, speed) + 0.03 * speed;
    line.x.push_back(speed);
    line.y.push_back(torque);
    if (step % 4 != 0 || step == 0) continue;
    points.x.push_back(speed);
    points.y.push_back(torque + 0.05);
    points.lower.push_back(torque - 0.25);
    points.upper.push_back(torque + 0.35);
  }
  return {"Friction curve", "Bars: 95 % intervals.", {"speed", "rad/s"}, {"torque", "Nm"}, {line, points}};
}

inline ScatterPlot order_spectrum() {
  ScatterSeries stems{"before", SeriesRole::before, SeriesStyle::stems, {}, {}, {}, {}};
  for (int order = 1; order <= 20; ++order) {
    stems.x.push_back(order);
    stems.y.push_back(order == 8 ? 0.3 : 0.01);
  }
  ScatterPlot plot{"Order spectrum", "", {"order", "per turn"}, {"amplitude", "rad/s"}, {stems}};
  plot.logarithmic_y = true;
  return plot;
}

inline BarChart ladder() {
  return {"Ladder of errors",
          "",
          "× floor",
          {{"training", SeriesRole::train}, {"validation", SeriesRole::validate}},
          {{"as given", {8.0, 10.0}, ""}, {"+ cogging", {1.0, std::nan("")}, "not validated"}},
          {{"floor", 1.0}}};
}

inline Report report(std::size_t samples = 4000) {
  Report report(std::string("Drive ") + hostile_text, hostile_text);
  report.section("Where", hostile_text);
  report.add(time_plot(samples));
  report.add(friction_curve());
  report.add(order_spectrum());
  report.section("How much");
  report.add(ladder());
  report.add(Table{"Parameters", "", {"name", "value"}, {{"J", "0.0060"}, {hostile_text, "-1.5"}}});
  report.add(Facts{"Drive", {{hostile_text, hostile_text}}});
  report.verdict({Tone::attention, "missing", "Cogging is missing.", {"It repeats every 10 mm."}, "axistool add …"});
  return report;
}

}  // namespace host::sample
