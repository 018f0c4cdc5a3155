#include <cmath>
#include <complex>
#include <numbers>

#include "host/axes/circle_signatures.hpp"

namespace host {

namespace {

using Eigen::Index;
using Eigen::Vector2d;

/// Searches the residual for waves of one kind over one axis. Rates are in cycles per mm, or Hz.
class WaveSearch {
 public:
  WaveSearch(const CircleRows& rows, const Eigen::VectorXd& left, WaveKind kind, char axis)
      : rows_(rows), left_(left), kind_(kind), axis_(axis) {
    double turn_Hz = 0.0;
    for (const CirclePass& pass : rows.passes()) {
      radius_ = std::max(radius_, pass.radius_mm);
      feed_ = std::max(feed_, pass.feed_mm_s);
      duration_s_ = std::max(duration_s_, pass.t_s.back() - pass.t_s.front());
      turn_Hz = std::max(turn_Hz, pass.turn_rad_s() / (2.0 * std::numbers::pi));
    }
    along_ = rows.angle_rad().array() - (axis == 'x' ? 0.0 : 0.5 * std::numbers::pi);
    along_ = along_.array().cos();
    constexpr double kTurns = 8.0;  // waves with fewer cycles per turn change the circle's shape
    lowest_ = over_time() ? kTurns * turn_Hz : 1.5 / radius_;
    highest_ = 0.99 * kMostCyclesARow / rows.row_s() / (over_time() ? 1.0 : feed_);
    step_ = over_time() ? 0.3 / duration_s_ : 0.15 / radius_;
  }

  void everywhere() {
    for (double rate = lowest_; rate < highest_; rate += step_) look(rate);
    near(at_);
  }
  void near(double rate) {
    best_ = -1.0;
    for (double part = 0.1; part > 1e-3; part *= 0.2) {
      for (int k = -10; k <= 10; ++k) look(rate + part * k * step_);
      rate = at_;
    }
  }

  CircleCause found() const { return wave_cause(rows_, kind_, axis_, over_time() ? at_ : 1.0 / at_); }

 private:
  bool over_time() const { return kind_ == WaveKind::vibration; }

  void look(double rate) {
    const double now = taken(rate);
    if (!(now > best_)) return;
    best_ = now;
    at_ = rate;
  }

  /// Part of the squared residual that a wave explains, with separate or common phases of passes and sensors.
  double taken(double rate) const {
    double sum = 0.0;
    Vector2d pull = Vector2d::Zero(), own = Vector2d::Zero();
    for (const CircleBlock& block : rows_.blocks()) {
      if (kind_ == WaveKind::cyclic_error && !block.is_outer) continue;
      if (over_time() && !shows_through(rate, rows_.row_s(block.pass))) continue;
      const double cycles = 2.0 * std::numbers::pi * rate;
      const double radius = rows_.passes()[block.pass].radius_mm;
      // Rows are equally spaced in time: the phase changes by the same angle from row to row.
      const std::complex<double> turn = std::polar(1.0, cycles * rows_.row_s(block.pass));
      std::complex<double> at = std::polar(1.0, cycles * rows_.time_s()(block.first));
      for (Index row = block.first; row < block.end; ++row) {
        if (!over_time()) at = std::polar(1.0, cycles * radius * along_(row));
        const Vector2d column = block.weight * along_(row) * Vector2d(at.real(), at.imag());
        pull += left_(row) * column;
        own += column.cwiseAbs2();
        at *= turn;
      }
      if (kind_ == WaveKind::cyclic_error) continue;
      sum += pull.cwiseAbs2().cwiseQuotient(own).sum();
      pull.setZero();
      own.setZero();
    }
    return kind_ == WaveKind::cyclic_error ? pull.cwiseAbs2().cwiseQuotient(own).sum() : sum;
  }

  const CircleRows& rows_;
  const Eigen::VectorXd& left_;
  WaveKind kind_;
  char axis_;
  Eigen::VectorXd along_;  ///< radial component of an error along the axis
  double radius_ = 0.0, feed_ = 0.0, duration_s_ = 0.0, lowest_ = 0.0, highest_ = 0.0, step_ = 0.0;
  double best_ = -1.0, at_ = 1.0;
};

}  // namespace

CircleCause best_wave(const CircleRows& rows, const Eigen::VectorXd& left, WaveKind kind, char axis) {
  WaveSearch search(rows, left, kind, axis);
  search.everywhere();
  return search.found();
}

CircleCause nearby_wave(const CircleRows& rows, const Eigen::VectorXd& left, const CircleCause& wave) {
  const WaveKind kind = wave.frequency_Hz ? WaveKind::vibration
                        : wave.outer_only ? WaveKind::cyclic_error
                                          : WaveKind::torque_ripple;
  WaveSearch search(rows, left, kind, wave.axis.front());
  search.near(wave.frequency_Hz ? *wave.frequency_Hz : 1.0 / *wave.period_mm);
  CircleCause found = search.found();
  if (kind == WaveKind::torque_ripple && wave.columns.cols() != found.columns.cols())
    return ripple_through_any_loop(rows, wave.axis.front(), *found.period_mm);
  return found;
}

}  // namespace host
