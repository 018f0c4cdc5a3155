#include "host/path/path_extents.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/exit_codes.hpp"

namespace host {

namespace {

double no_minus_zero(double value) { return std::abs(value) < 5e-7 ? 0.0 : value; }

}  // namespace

PathExtents extents_of(const PlannedPath& path) {
  PathExtents found{path.knots.front().position, path.knots.front().position};
  for (std::size_t k = 0; k + 1 < path.knots.size(); ++k) {
    constexpr int kParts = 4;
    for (int i = 1; i <= kParts; ++i) {
      const double time_s = path.knots[k].time_s + (path.knots[k + 1].time_s - path.knots[k].time_s) * i / kParts;
      const PathPoint point = between(path.knots[k], path.knots[k + 1], time_s).position;
      found.least = found.least.cwiseMin(point);
      found.most = found.most.cwiseMax(point);
    }
  }
  found.least = found.least.unaryExpr(&no_minus_zero);
  found.most = found.most.unaryExpr(&no_minus_zero);
  return found;
}

void require_inside(const PlannedPath& path, const PathExtents& limits, std::size_t axes, const std::string& name) {
  for (const PlannedCurve& one : path.curves) {
    const auto parts = std::max(2, static_cast<int>(one.curve.turning() * 32.0));
    for (int i = 0; i <= parts; ++i) {
      const PathPoint point = one.curve.at(one.curve.length() * i / parts).point;
      for (std::size_t axis = 0; axis < axes; ++axis) {
        const auto k = static_cast<Eigen::Index>(axis);
        if (point[k] >= limits.least[k] && point[k] <= limits.most[k]) continue;
        throw Failure(
            ExitCode::refused,
            fmt::format("{}:{}: {} = {:.4f} mm is beyond its travel, {:g} to {:g} mm: nothing has moved. Move "
                        "the program, or monitor.travel_min and travel_max where the machine has the room",
                        name, one.line, "xyz"[axis], point[k], limits.least[k], limits.most[k]));
      }
    }
  }
}

}  // namespace host
