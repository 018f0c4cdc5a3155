#include "host/effort/effort_memory.hpp"

#include <algorithm>
#include <utility>

#include "host/infer/memory_builder.hpp"
#include "host/statistics.hpp"

namespace host {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<RowRun> runs_of(const EffortRows& rows) {
  std::vector<RowRun> runs;
  const auto n = static_cast<Index>(rows.size());
  std::size_t last = 0;
  for (Index k = 0; k < n; ++k) {
    const std::size_t record = rows.record[static_cast<std::size_t>(k)];
    const EffortSignals& signals = rows.signals[record];
    const std::size_t sample = signals.kept[static_cast<std::size_t>(k) - signals.first_row];
    const std::size_t stride = signals.kept.size() > 1 ? signals.kept[1] - signals.kept[0] : 1;
    const bool follows = k > 0 && rows.record[static_cast<std::size_t>(k) - 1] == record && sample <= last + 2 * stride;
    if (!follows) runs.push_back({k, k});
    runs.back().end = k + 1;
    last = sample;
  }
  return runs;
}

Memory effort_memory(const EffortRows& rows, const VectorXd& explained, double usual) {
  const VectorXd direction = rows.w.unaryExpr([](double w) { return w > 0.0 ? 1.0 : -1.0; });
  const VectorXd forward = 0.5 * (1.0 + direction.array()), backward = 0.5 * (1.0 - direction.array());
  const VectorXd speed = rows.w.cwiseAbs();
  std::vector<double> sizes(speed.begin(), speed.end());
  const double top = quantile(std::move(sizes), 0.98);
  MemoryBuilder memory;
  std::vector<double> knots = knots_by_factor(0.02 * top, 1.2 * top, 7);
  knots.insert(knots.begin(), 0.0);
  const MatrixXd over_speed = hats(speed, knots);
  MatrixXd by_direction(over_speed.rows(), 2 * over_speed.cols());
  by_direction << forward.asDiagonal() * over_speed, backward.asDiagonal() * over_speed;
  // Constant and viscous friction, equal or by direction.
  MatrixXd plain(rows.w.size(), 4);
  plain << forward, backward, rows.w, speed;
  memory.add("speed", beside(by_direction, plain));
  if (rows.has_position && rows.x.maxCoeff() > rows.x.minCoeff()) {
    const MatrixXd over_position = hats(rows.x, even_knots(rows.x.minCoeff(), rows.x.maxCoeff(), 12));
    memory.add("position", over_position);
    memory.add("position", direction.asDiagonal() * over_position);
    const VectorXd since = travel_since_reversal(rows);
    const double travel = rows.x.maxCoeff() - rows.x.minCoeff();
    if (since.maxCoeff() > 0.0)
      memory.add("travel_since_reversal",
                 direction.asDiagonal() * hats(since, knots_by_factor(1e-4 * travel, 0.3 * travel, 8)));
  }
  const double first_s = rows.t_s.minCoeff(), last_s = rows.t_s.maxCoeff();
  if (last_s > first_s) memory.add("time", direction.asDiagonal() * hats(rows.t_s, even_knots(first_s, last_s, 6)));
  const VectorXd load = explained.cwiseAbs();
  const VectorXd way = explained.unaryExpr([](double value) { return value > 0.0 ? 1.0 : -1.0; });
  if (load.maxCoeff() > 0.0) memory.add("current", way.asDiagonal() * hats(load, even_knots(0.0, load.maxCoeff(), 6)));
  const std::size_t records = rows.signals.size();
  if (records > 1) {
    MatrixXd level = MatrixXd::Zero(rows.w.size(), static_cast<Index>(records));
    for (Index k = 0; k < level.rows(); ++k)
      level(k, static_cast<Index>(rows.record[static_cast<std::size_t>(k)])) = 1.0;
    memory.add("record", level);
  }
  return memory.take(usual);
}

}  // namespace host
