#include "host/path/time_warp.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace host {

namespace {

using Local = Eigen::Vector3d;  ///< r^2 and its first two derivatives by time, or a gradient with respect to them
using Basis = Eigen::Matrix3d;  ///< maps a cell's three coefficients to r^2 and its derivatives

constexpr int kPoints = 3;  ///< checked points in a cell

/// Basis of B-splines over cells that begin at times[cell]. Beyond each end follows a further cell of the same length
/// as the end cell.
Basis basis_at(const std::vector<double>& times, std::size_t cell, double share) {
  const double own = times[cell + 1] - times[cell];
  const double before = cell > 0 ? times[cell] - times[cell - 1] : own;
  const double after = cell + 2 < times.size() ? times[cell + 2] - times[cell + 1] : own;
  const double first = own / (before + own), last = own / (own + after), left = 1.0 - share;
  Basis b;
  b.row(0) << left * left * first, 0.0, share * share * last;
  b.row(1) << -2.0 * left * first / own, 0.0, 2.0 * share * last / own;
  b.row(2) << 2.0 * first / (own * own), 0.0, 2.0 * last / (own * own);
  b.col(1) = Local::UnitX() - b.col(0) - b.col(2);
  return b;
}

/// Bounds of r^2 and its derivatives at a checked point.
struct Checked {
  std::array<Local, 3> acceleration, jerk;  ///< of each axis, relative to its limit
  double most = 0.0;                        ///< largest r^2
};

/// Barrier function: duration minus weighted logarithms of the distances to the limits, with its gradient and its
/// Hessian (without the curvature of the jerk's factor).
class Barrier {
 public:
  Barrier(std::vector<Checked> points, const std::vector<double>& times) : points_(std::move(points)) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      basis_.push_back(basis_at(times, i / kPoints, (static_cast<double>(i % kPoints) + 0.5) / kPoints));
      time_s_.push_back((times[i / kPoints + 1] - times[i / kPoints]) / kPoints);
    }
  }

  std::size_t coefficients() const { return points_.size() / kPoints + 2; }
  double constraints() const { return 14.0 * static_cast<double>(points_.size()); }

  /// Value of the barrier function; empty if a limit is exceeded.
  std::optional<double> value(const Eigen::VectorXd& c, double weight) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Local z = basis_[i] * c.segment<3>(static_cast<Eigen::Index>(i / kPoints));
      if (!(z[0] > kLeast) || !(z[0] < points_[i].most)) return {};
      const double inverse = 1.0 / std::sqrt(z[0]);
      double product = (z[0] - kLeast) * (points_[i].most - z[0]) / points_[i].most;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double a = points_[i].acceleration[axis].dot(z), j = points_[i].jerk[axis].dot(z);
        if (!(std::abs(a) < 1.0) || !(std::abs(j) < inverse)) return {};
        product *= (1.0 - a * a) * (inverse * inverse - j * j);
      }
      sum += time_s_[i] * inverse - weight * std::log(product);
    }
    return sum;
  }

  double time(const Eigen::VectorXd& c) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i)
      sum += time_s_[i] / std::sqrt((basis_[i] * c.segment<3>(static_cast<Eigen::Index>(i / kPoints)))[0]);
    return sum;
  }

  /// Newton step.
  Eigen::VectorXd step(const Eigen::VectorXd& c, double weight) const {
    const auto n = static_cast<Eigen::Index>(coefficients());
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd band = Eigen::MatrixXd::Zero(3, n);  // band(k, i): element (i, i + k)
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i / kPoints);
      const Basis& b = basis_[i];
      const Local z = b * c.segment<3>(at);
      const double inverse = 1.0 / std::sqrt(z[0]);
      Local slope = Local::Zero();
      Basis bend = Basis::Zero();
      slope[0] -= 0.5 * time_s_[i] * inverse / z[0];
      bend(0, 0) += 0.75 * time_s_[i] * inverse / (z[0] * z[0]);
      const auto add = [&](double left, const Local& towards) {  // -weight log(left), whose gradient is -towards
        slope += weight / left * towards;
        bend += weight / (left * left) * towards * towards.transpose();
      };
      add(z[0] - kLeast, -Local::UnitX());
      add(points_[i].most - z[0], Local::UnitX());
      const Local relief = 0.5 * inverse / z[0] * Local::UnitX();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Local &a = points_[i].acceleration[axis], &j = points_[i].jerk[axis];
        if (a.isZero(0.0) && j.isZero(0.0)) continue;
        add(1.0 - a.dot(z), a);
        add(1.0 + a.dot(z), -a);
        add(inverse - j.dot(z), j + relief);
        add(inverse + j.dot(z), relief - j);
      }
      gradient.segment<3>(at) += b.transpose() * slope;
      const Basis whole = b.transpose() * bend * b;
      for (Eigen::Index k = 0; k < 3; ++k)
        for (Eigen::Index m = 0; m + k < 3; ++m) band(k, at + m) += whole(m, m + k);
    }
    return -solved(std::move(band), std::move(gradient));
  }

 private:
  static constexpr double kLeast = 1e-3;

  /// Solves the banded system by Cholesky factors without roots (LDL^T).
  static Eigen::VectorXd solved(Eigen::MatrixXd band, Eigen::VectorXd x) {
    const Eigen::Index n = x.size();
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = 1; k < 3 && i + k < n; ++k) {
        const double factor = band(k, i) / band(0, i);
        for (Eigen::Index m = k; m < 3 && i + m < n; ++m) band(m - k, i + k) -= factor * band(m, i);
        x[i + k] -= factor * x[i];
      }
    }
    for (Eigen::Index i = n; i-- > 0;) {
      x[i] /= band(0, i);
      for (Eigen::Index k = 1; k < 3 && i + k < n; ++k) x[i] -= band(k, i) / band(0, i) * x[i + k];
    }
    return x;
  }

  std::vector<Checked> points_;
  std::vector<Basis> basis_;
  std::vector<double> time_s_;
};

Checked checked(const WarpDemand& d, const AxisLimits& limits) {
  Checked made;
  made.most = d.fastest * d.fastest;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    made.acceleration[axis] = Local(d.acceleration[i], d.velocity[i] / 2.0, 0.0) / (d.share * limits.acceleration[i]);
    made.jerk[axis] = Local(d.jerk[i], 1.5 * d.acceleration[i], d.velocity[i] / 2.0) / (d.share * limits.jerk[i]);
    const double share = limits.velocity[i] / std::max(std::abs(d.velocity[i]), 1e-12);
    made.most = std::min(made.most, share * share);
  }
  made.most = std::min(made.most, 1e4);
  return made;
}

/// A constant rate within all limits, as starting point.
std::optional<Eigen::VectorXd> beginning(const Barrier& barrier) {
  for (double square = 0.95; square > 0.2; square *= 0.9) {
    Eigen::VectorXd c = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(barrier.coefficients()), square);
    if (barrier.value(c, 1.0)) return c;
  }
  return {};
}

Eigen::VectorXd quickest(const Barrier& barrier, Eigen::VectorXd c) {
  // For a convex problem the gap to the optimum is the weight times the number of limits.
  constexpr double kFirstGap = 0.3, kLastGap = 1e-3, kLess = 0.45;
  for (double gap = kFirstGap; gap > kLastGap; gap *= kLess) {
    const double weight = gap * barrier.time(c) / barrier.constraints();
    for (int k = 0; k < 4; ++k) {
      const Eigen::VectorXd step = barrier.step(c, weight);
      if (!step.allFinite()) return c;
      const double before = *barrier.value(c, weight);
      double share = 1.0;
      bool is_better = false;
      for (int m = 0; m < 20 && !is_better; ++m, share *= 0.6) {
        const auto tried = barrier.value(c + share * step, weight);
        is_better = tried && *tried < before;
        if (is_better) c += share * step;
      }
      if (!is_better || step.cwiseAbs().maxCoeff() < 1e-3) break;
    }
  }
  return c;
}

}  // namespace

TimeWarp::TimeWarp(std::vector<double> cells, const std::function<WarpDemand(double, double)>& demand,
                   const AxisLimits& limits) {
  std::vector<Checked> points;
  for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
    const double part_s = (cells[i + 1] - cells[i]) / kPoints;
    for (int k = 0; k < kPoints; ++k)
      points.push_back(checked(demand(cells[i] + k * part_s, cells[i] + (k + 1) * part_s), limits));
  }
  const Barrier barrier(std::move(points), cells);
  const auto begin = beginning(barrier);
  if (!begin) return;
  const Eigen::VectorXd c = quickest(barrier, *begin);
  cells_ = std::move(cells);
  square_.assign(c.begin(), c.end());
  times_.assign(1, 0.0);
  for (std::size_t i = 0; i + 1 < cells_.size(); ++i) times_.push_back(times_.back() + passed(i, 1.0));
  if (times_.back() >= cells_.back()) {
    *this = {};
    return;
  }
  constexpr double kNothing = 1e-5;  // ignored change of r^2 in a cell: 0.1 % of the fastest axis's jerk
  double before = 0.0;
  for (std::size_t i = 0; i + 1 < cells_.size(); ++i) {
    const double bend = basis_at(cells_, i, 0.5).row(2).dot(Eigen::Map<const Local>(&square_[i]));
    const double cell_s = cells_[i + 1] - cells_[i];
    if (i > 0 && std::abs(bend - before) * cell_s * cell_s > kNothing) bends_.push_back(times_[i]);
    before = bend;
  }
}

TimeWarp::Square TimeWarp::square_at(std::size_t cell, double share) const {
  const Local z = basis_at(cells_, cell, share) * Eigen::Map<const Local>(&square_[cell]);
  return {z[0], z[1]};
}

double TimeWarp::passed(std::size_t cell, double share) const {
  // Gauss quadrature with three points.
  const double off = std::sqrt(0.6), half = share / 2.0;
  return (cells_[cell + 1] - cells_[cell]) * half / 9.0 *
         (5.0 / std::sqrt(square_at(cell, half * (1.0 - off)).value) + 8.0 / std::sqrt(square_at(cell, half).value) +
          5.0 / std::sqrt(square_at(cell, half * (1.0 + off)).value));
}

TimeWarp::State TimeWarp::at(double warped_s) const {
  if (is_none()) return {warped_s, 1.0, 0.0};
  const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, warped_s);
  const auto cell = static_cast<std::size_t>(next - times_.begin()) - 1;
  const double cell_s = cells_[cell + 1] - cells_[cell];
  const double wanted = std::clamp(warped_s, 0.0, times_.back()) - times_[cell];
  double share = wanted / (times_[cell + 1] - times_[cell]);
  for (int k = 0; k < 4; ++k)
    share += (wanted - passed(cell, share)) * std::sqrt(square_at(cell, share).value) / cell_s;
  const Square z = square_at(cell, share);
  return {cells_[cell] + cell_s * share, std::sqrt(z.value), z.slope / 2.0};
}

double TimeWarp::warped(double time_s) const {
  if (is_none()) return time_s;
  const double inside = std::clamp(time_s, 0.0, cells_.back());
  const auto next = std::upper_bound(cells_.begin() + 1, cells_.end() - 1, inside);
  const auto cell = static_cast<std::size_t>(next - cells_.begin()) - 1;
  return times_[cell] + passed(cell, (inside - cells_[cell]) / (cells_[cell + 1] - cells_[cell]));
}

}  // namespace host
