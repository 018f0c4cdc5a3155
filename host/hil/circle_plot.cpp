#include "host/hil/circle_plot.hpp"

#include <cmath>

namespace host {

std::optional<PolarPlot> circle_plot(const Scenario& scenario, const std::vector<CircleRun>& runs) {
  const Path* last = nullptr;
  for (const ScenarioMove& move : scenario.moves)
    if (move.path) last = &*move.path;
  const auto circle = last == nullptr ? std::nullopt : last->whole_circle();
  if (!circle) return {};
  PolarPlot plot;
  plot.title = "The circle";
  plot.caption = "Encoders' distance from the circle, about it.";
  plot.radius_mm = std::hypot(circle->begin.x - circle->centre.x, circle->begin.y - circle->centre.y);
  for (const CircleRun& one : runs) {
    PolarTrace trace{one.name, one.role, {}, {}};
    for (const PlanePoint& point : one.run->path_points) {
      const double x = point.x - circle->centre.x, y = point.y - circle->centre.y;
      trace.angle_rad.push_back(std::atan2(y, x));
      trace.deviation_um.push_back(1e3 * (std::hypot(x, y) - plot.radius_mm));
    }
    if (!trace.angle_rad.empty()) plot.traces.push_back(std::move(trace));
  }
  if (plot.traces.empty()) return {};
  return plot;
}

}  // namespace host
