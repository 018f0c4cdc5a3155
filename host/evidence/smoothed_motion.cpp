#include "host/evidence/smoothed_motion.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/dense_solutions.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/effort_timing.hpp"
#include "host/identify/repeated_counts.hpp"
#include "host/statistics.hpp"
#include "sim/drive.hpp"

namespace host {

using Eigen::Matrix3d;
using Eigen::RowVector3d;
using Eigen::Vector3d;

/// One measurement for the smoother.
struct MotionSmoother::Observation {
  double value;     ///< travel or speed
  double variance;  ///< of `value`
  double step_V;    ///< standard deviation of the disturbance's next step
  bool standing;    ///< the speed is zero
};

namespace {

/// Step of the disturbance's random walk per sample at 1 kHz, as a part of the friction level: 0.03 V on the paper's x
/// axis. That is a tenth of the on-line variance (48), because a smoother uses both sides of a sample. It averages the
/// speed over some 5 ms. If there is hardly any friction, a part of the command's RMS is used.
constexpr double kQuietPartOfFriction = 0.045;
constexpr double kQuietPartOfCommand = 0.01;

/// Signals farther than this from a sample do not affect its smoothed state, s: ten times the averaging time of the
/// speed.
constexpr double kReach_s = 0.05;

/// Part of a recent change of the command that may act differently from the model (dead time, current loop).
constexpr double kCommandDoubt = 0.3;

/// This uncertainty lasts this long after a change of the command, s.
constexpr double kCommandMemory_s = 0.004;

/// An axis without an encoder edge for this long stands still, s.
constexpr double kStanding_s = 0.06;

/// An axis moves before its first encoder edge; this time before the edge is not standstill, s.
constexpr double kStart_s = 0.006;

/// At standstill the speed is zero except for creep below one count: at most this fraction of a count per kStanding_s.
constexpr double kCreepCounts = 0.1;

std::vector<bool> find_standing(const std::vector<double>& x, double resolution, double period_s) {
  std::vector<bool> standing(x.size(), false);
  const auto shortest = static_cast<std::size_t>(std::max(2.0, kStanding_s / period_s));
  const auto start = static_cast<std::size_t>(kStart_s / period_s);
  std::size_t begin = 0;
  for (std::size_t k = 1; k <= x.size(); ++k) {
    if (k < x.size() && std::abs(x[k] - x[begin]) <= 0.25 * resolution) continue;
    if (k - begin >= shortest) {
      // The axis may still move at the first sample on a count and at the last ones, unless the record ends there.
      const std::size_t end = k < x.size() ? k - std::min(start, k - begin) : k;
      for (std::size_t row = begin == 0 ? 0 : begin + 1; row < end; ++row) standing[row] = true;
    }
    begin = k;
  }
  return standing;
}

/// Information of a quantised position: much at an edge, where the axis is between two counts; little on a count; less
/// if the errors of successive counts are alike. `alike`: see repeated_counts().
template <typename Observations>
void observe_counts(const std::vector<double>& x, double resolution, double period_s, double lead,
                    const std::vector<double>& w, const std::vector<double>& alike, Observations& observed) {
  const double noise = resolution * resolution / 12.0;  // eq. (12)
  for (std::size_t k = 1; k < x.size(); ++k) {
    const double counts = std::abs(x[k] - x[k - 1]) / resolution;
    auto& sample = observed[k];
    if (counts > 1.5) {
      sample.variance *= alike[k];
      continue;
    }
    if (counts > 0.5) {
      const double moved = std::clamp(w[k] * lead * period_s, -resolution, resolution);
      sample.value = 0.5 * (x[k] + x[k - 1]) + 0.5 * moved;
      sample.variance = moved * moved / 12.0 + 0.01 * noise;
    } else {
      sample.variance = 4.0 * noise;
    }
  }
}

/// At a reversal the disturbance may jump by the friction level.
template <typename Observations>
void doubt_friction(const std::vector<double>& w, const std::vector<bool>& standing, double level_V,
                    Observations& observed) {
  constexpr std::size_t kReach = 2;  // samples; uncertainty of the time of a start or reversal
  for (std::size_t k = 1; k < w.size(); ++k) {
    if (!(w[k] * w[k - 1] < 0.0 || standing[k] != standing[k - 1])) continue;
    for (std::size_t row = k - std::min(k, kReach + 1); row < std::min(w.size(), k + kReach); ++row)
      observed[row].step_V = std::max(observed[row].step_V, level_V);
  }
}

template <typename Observations>
void doubt_command(const std::vector<double>& u_V, double period_s, Observations& observed) {
  const auto memory = std::max<std::size_t>(1, static_cast<std::size_t>(kCommandMemory_s / period_s));
  for (std::size_t k = 1; k < u_V.size(); ++k) {
    const double doubt_V = kCommandDoubt * std::abs(u_V[k] - u_V[k - 1]);
    for (std::size_t row = k - 1; row < std::min(u_V.size(), k + memory); ++row)
      observed[row].step_V = std::max(observed[row].step_V, doubt_V);
  }
}

double inertia_of(const sim::DriveDescription& model) {
  if (const sim::EffectEntry* inertia = model.find("inertia")) return inertia->at("J");
  throw Failure(ExitCode::bad_input,
                model.name + ": the model has no [[effect]] of kind \"inertia\"; identify the drive first");
}

double viscous_of(const sim::DriveDescription& model) {
  const sim::EffectEntry* viscous = model.find("viscous");
  return viscous == nullptr ? 0.0 : viscous->at("B");
}

double friction_level_of(const sim::DriveDescription& model) {
  const sim::Drive drive(model);
  return drive.friction[0].coulomb + drive.friction[1].coulomb;
}

}  // namespace

double current_per_volt(const Record& record, const sim::DataSheet& data) {
  const double gain_A_per_V = data.kind == sim::DriveKind::rotary ? data.amplifier_gain_A_per_V
                              : data.torque_constant_Nm_per_A > 0.0
                                  ? data.effort_per_volt() / data.torque_constant_Nm_per_A
                                  : 0.0;
  if (record.i_A.empty())
    throw Failure(ExitCode::bad_input, record.path +
                                           ": the record has no command or current (u_V or i_A), which this needs; "
                                           "axistool compare shows the tracking error");
  if (gain_A_per_V <= 0.0)
    throw Failure(ExitCode::bad_input, record.path +
                                           ": no column u_V, and i_A needs amplifier_gain_A_per_V (a linear drive: "
                                           "force_constant_N_per_A) in the model");
  return gain_A_per_V;
}

std::vector<double> command_volts(const Record& record, const sim::DataSheet& data) {
  if (!record.u_V.empty()) return record.u_V;
  const double gain_A_per_V = current_per_volt(record, data);
  std::vector<double> u_V = acting_current(record);
  for (double& value : u_V) value /= gain_A_per_V;
  return u_V;
}

MotionSmoother::MotionSmoother(const Record& record, const sim::DriveDescription& model)
    : MotionSmoother(record, model.data, inertia_of(model), viscous_of(model), friction_level_of(model)) {}

MotionSmoother::MotionSmoother(const Record& record, const sim::DataSheet& data, double inertia, double viscous,
                               double friction_level)
    : by_position_(record.has_position()),
      reach_(static_cast<std::size_t>(std::ceil(kReach_s / record.sample_period_s))),
      effort_per_volt_(data.effort_per_volt()) {
  const double period_s = record.sample_period_s;
  // Eqs. (5), (7), (16) by the matrix exponential.
  const double gain = effort_per_volt_ / inertia;
  Eigen::Matrix4d continuous = Eigen::Matrix4d::Zero();
  continuous(0, 1) = data.lead;
  continuous(1, 1) = -viscous / inertia;
  continuous(1, 2) = -gain;
  continuous(1, 3) = gain;
  const Eigen::Matrix4d discrete = exponential(continuous * period_s);
  A_ = discrete.topLeftCorner<3, 3>();
  B_ = discrete.topRightCorner<3, 1>();

  const std::vector<double> u_V = command_volts(record, data);
  const std::vector<double>& measured = by_position_ ? record.x : record.w;
  const double resolution = data.encoder_resolution;
  const double noise =
      by_position_ ? std::max(resolution * resolution / 12.0, 1e-18) : data.tach_noise_variance.value_or(1e-6);
  const double level_V = friction_level / effort_per_volt_;
  const double rms_V = root_mean_square(u_V);
  const double quiet_V =
      std::max({kQuietPartOfFriction * level_V, kQuietPartOfCommand * rms_V, std::numeric_limits<double>::min()}) *
      std::sqrt(period_s / 1e-3);
  motion_.hidden_creep = resolution / data.lead / kStanding_s;
  const double creep = kCreepCounts * motion_.hidden_creep;

  std::vector<Observation> observed(record.size());
  for (std::size_t k = 0; k < record.size(); ++k) observed[k] = {measured[k], noise, quiet_V, false};
  doubt_command(u_V, period_s, observed);
  const Vector3d start(by_position_ ? measured[0] : 0.0, by_position_ ? 0.0 : measured[0], u_V[0]);
  // Uncertainty of the initial state: a disturbance as large as friction or command, and its effect over a tenth of a
  // second.
  constexpr double kUnknown_s = 0.1;
  const double unknown_V = std::max({level_V, rms_V, quiet_V});
  const double unknown_w = gain * unknown_V * kUnknown_s;
  const double unknown_x = std::max(data.lead * unknown_w * kUnknown_s, std::sqrt(noise));
  const Vector3d start_variance = Vector3d(unknown_x, unknown_w, unknown_V).array().square();
  solve_gains(observed, creep * creep, start_variance);
  smooth(observed, u_V, start);
  if (!by_position_) return;

  // The first pass finds the reversals, which the second pass needs.
  const std::vector<double> rough_w = motion_.w;
  const std::vector<bool> standing = find_standing(record.x, resolution, period_s);
  for (std::size_t k = 0; k < record.size(); ++k) observed[k].standing = standing[k];
  doubt_friction(rough_w, standing, level_V, observed);
  if (resolution > 0.0) {
    const auto quietest = std::ranges::min_element(motion_.w_variance) - motion_.w_variance.begin();
    const std::vector<double> alike =
        repeated_counts(motion_.x, resolution, shift_weights(static_cast<std::size_t>(quietest)).w_of_reading);
    observe_counts(record.x, resolution, period_s, data.lead, rough_w, alike, observed);
  }
  solve_gains(observed, creep * creep, start_variance);
  smooth(observed, u_V, start);
}

void MotionSmoother::solve_gains(const std::vector<Observation>& observed, double creep_variance,
                                 const Vector3d& start_variance) {
  const std::size_t n = observed.size();
  const Eigen::Index seen = by_position_ ? 0 : 1;
  const auto correct = [](Matrix3d& P, Eigen::Index channel, double variance) -> Vector3d {
    const Vector3d column = P.col(channel);
    const Vector3d K = column / (column(channel) + variance);
    P -= K * column.transpose();
    P = 0.5 * (P + P.transpose().eval());
    return K;
  };
  gains_.resize(n);
  std::vector<Matrix3d> filtered(n), predicted(n);
  Matrix3d P = start_variance.asDiagonal();
  for (std::size_t k = 0; k < n; ++k) {
    predicted[k] = P;
    gains_[k].standing = observed[k].standing;
    gains_[k].measurement = correct(P, seen, observed[k].variance);
    if (observed[k].standing) gains_[k].standstill = correct(P, 1, creep_variance);
    filtered[k] = P;
    P = A_ * P * A_.transpose();
    P(2, 2) += observed[k].step_V * observed[k].step_V;
  }
  motion_.x_variance.resize(n);
  motion_.w_variance.resize(n);
  motion_.xw_covariance.resize(n);
  Matrix3d smoothed = filtered[n - 1];
  for (std::size_t k = n; k-- > 0;) {
    if (k + 1 < n) {
      gains_[k].backward = symmetric_solution_of_3(predicted[k + 1], A_ * filtered[k]).transpose();
      smoothed = filtered[k] + gains_[k].backward * (smoothed - predicted[k + 1]) * gains_[k].backward.transpose();
    }
    motion_.x_variance[k] = smoothed(0, 0);
    motion_.w_variance[k] = observed[k].standing ? 0.0 : smoothed(1, 1);
    motion_.xw_covariance[k] = observed[k].standing ? 0.0 : smoothed(0, 1);
  }
}

void MotionSmoother::smooth(const std::vector<Observation>& observed, const std::vector<double>& u_V,
                            const Vector3d& start) {
  const std::size_t n = observed.size();
  motion_.x.resize(n);
  motion_.w.resize(n);
  motion_.disturbance.resize(n);
  motion_.standing.resize(n);
  const Eigen::Index seen = by_position_ ? 0 : 1;
  std::vector<Vector3d> filtered(n), predicted(n);
  Vector3d state = start;
  for (std::size_t k = 0; k < n; ++k) {
    predicted[k] = state;
    state += gains_[k].measurement * (observed[k].value - state(seen));
    if (gains_[k].standing) state -= gains_[k].standstill * state(1);
    filtered[k] = state;
    state = A_ * state + B_ * u_V[k];
  }
  Vector3d later = filtered[n - 1];
  for (std::size_t k = n; k-- > 0;) {
    if (k + 1 < n) later = filtered[k] + gains_[k].backward * (later - predicted[k + 1]);
    motion_.x[k] = later(0);
    motion_.w[k] = observed[k].standing ? 0.0 : later(1);
    motion_.disturbance[k] = effort_per_volt_ * later(2);
    motion_.standing[k] = observed[k].standing;
  }
}

ShiftWeights MotionSmoother::shift_weights(std::size_t row) const {
  // The two passes transposed: from the state of one row back to every input that affects it.
  const Eigen::Index seen = by_position_ ? 0 : 1;
  ShiftWeights weights;
  weights.first = row - std::min(row, reach_);
  const std::size_t count = std::min(row + reach_, gains_.size() - 1) - weights.first;
  std::vector<Vector3d> of_filtered(count), of_predicted(count + 1);
  const auto run = [&](const Vector3d& wanted, std::vector<double>& of_reading, std::vector<double>& of_command) {
    of_reading.assign(count, 0.0);
    of_command.assign(count, 0.0);
    std::ranges::fill(of_filtered, Vector3d::Zero());
    std::ranges::fill(of_predicted, Vector3d::Zero());
    Vector3d later = wanted;
    for (std::size_t k = row - weights.first; k < count; ++k) {
      of_filtered[k] = later;
      if (k + 1 == count) break;
      later = (gains_[weights.first + k].backward.transpose() * later).eval();
      of_predicted[k + 1] -= later;
    }
    for (std::size_t k = count; k-- > 0;) {
      const Gains& gains = gains_[weights.first + k];
      Vector3d state = of_filtered[k] + A_.transpose() * of_predicted[k + 1];
      of_command[k] = B_.dot(of_predicted[k + 1]);
      if (gains.standing) state(1) -= gains.standstill.dot(state);
      of_reading[k] = gains.measurement.dot(state);
      state(seen) -= of_reading[k];
      of_predicted[k] += state;
    }
    if (by_position_ && count > 0) of_reading[0] += of_predicted[0](0);
  };
  run(Vector3d::UnitX(), weights.x_of_reading, weights.x_of_command);
  const double moves = gains_[row].standing ? 0.0 : 1.0;
  run(moves * Vector3d::UnitY(), weights.w_of_reading, weights.w_of_command);
  return weights;
}

ShiftWeights::Shift ShiftWeights::shift(std::span<const double> reading, std::span<const double> command_V) const {
  const auto product = [](const std::vector<double>& weights, std::span<const double> changes) {
    return std::transform_reduce(changes.begin(), changes.end(), weights.begin(), 0.0);
  };
  return {product(x_of_reading, reading) + product(x_of_command, command_V),
          product(w_of_reading, reading) + product(w_of_command, command_V)};
}

}  // namespace host
