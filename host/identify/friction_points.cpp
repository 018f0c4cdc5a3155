#include "host/identify/friction_points.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/identify/motion.hpp"
#include "host/identify/zero_phase_filter.hpp"

namespace host {

namespace {

/// Average over an interval with soft ends: the mean over `length` samples, averaged again over every start in the
/// first and last `soft` samples with Hann weights. Sums of J dw/dt then only need speeds averaged over the soft ends,
/// which the encoder gives accurately; a plain mean would need the speed at two instants. Whole turns of the screw stay
/// whole.
class SoftMean {
 public:
  SoftMean(std::size_t begin, std::size_t end, double samples_per_turn) : begin_(begin) {
    constexpr std::size_t kSoftestEnd = 100;  // samples
    const std::size_t span = end - begin;
    const std::size_t soft = std::clamp<std::size_t>(span / 4, 2, kSoftestEnd);
    length_ = span - soft;
    turns_ = samples_per_turn > 0.0 ? static_cast<double>(length_) / samples_per_turn : 0.0;
    if (turns_ >= 1.0) {
      turns_ = std::floor(turns_);
      length_ = static_cast<std::size_t>(std::lround(turns_ * samples_per_turn));
    }
    double sum = 0.0;
    for (std::size_t j = 0; j < soft; ++j) {
      weights_.push_back(1.0 -
                         std::cos(2.0 * std::numbers::pi * (static_cast<double>(j) + 0.5) / static_cast<double>(soft)));
      sum += weights_.back();
    }
    for (double& weight : weights_) weight /= sum;
  }

  double turns() const { return turns_; }
  std::size_t length() const { return length_; }

  double of(const std::vector<double>& signal) const {
    double window = 0.0, mean = 0.0;
    for (std::size_t k = begin_; k < begin_ + length_; ++k) window += signal[k];
    for (std::size_t j = 0; j < weights_.size(); ++j) {
      mean += weights_[j] * window;
      window += signal[begin_ + j + length_] - signal[begin_ + j];
    }
    return mean / static_cast<double>(length_);
  }

  /// Mean change per sample: the difference of the soft ends over the length.
  double of_slope(const std::vector<double>& signal) const {
    double first = 0.0, last = 0.0;
    for (std::size_t j = 0; j < weights_.size(); ++j) {
      first += weights_[j] * signal[begin_ + j];
      last += weights_[j] * signal[begin_ + j + length_];
    }
    return (last - first) / static_cast<double>(length_);
  }

 private:
  std::size_t begin_, length_;
  double turns_;
  std::vector<double> weights_;
};

/// The signals of one record from which the means are computed, one value per sample.
struct Signals {
  std::vector<double> effort;       ///< torque or force of the motor, held from the sample on
  std::vector<double> travel;       ///< rad or m; empty if there is no position
  std::vector<double> speed;        ///< central difference of the travel, or the tachometer
  std::vector<double> disturbance;  ///< V; empty if there is no position
  std::vector<double> jitter;       ///< speed above 10 Hz caused by the torque or force alone
  double period_s = 0.0;
};

/// Integral of the high-frequency torque or force over the inertia: changes of the speed between encoder counts.
std::vector<double> speed_jitter(const std::vector<double>& effort, double inertia, double period_s) {
  constexpr double kSlowest_Hz = 10.0;  // below it, the position loop keeps the speed constant
  const double rate_Hz = 1.0 / period_s;
  const auto slow = ZeroPhaseLowPass::butterworth(std::min(kSlowest_Hz, 0.1 * rate_Hz), rate_Hz);
  std::vector<double> speed(effort.size());
  for (std::size_t k = 1; k < effort.size(); ++k) speed[k] = speed[k - 1] + effort[k - 1] * period_s / inertia;
  const std::vector<double> drift = slow(speed);
  for (std::size_t k = 0; k < speed.size(); ++k) speed[k] -= drift[k];
  return speed;
}

Signals signals_of(const Record& record, const AxisDesign& design, const sim::DataSheet& data) {
  Signals signals;
  signals.period_s = record.sample_period_s;
  signals.effort = motor_effort(record, data);
  signals.jitter = speed_jitter(signals.effort, design.axis.inertia, record.sample_period_s);
  if (!record.has_position()) {
    signals.speed = record.w;
    return signals;
  }
  for (const double x : record.x) signals.travel.push_back((x - record.x.front()) / data.lead);
  signals.speed = central_difference(signals.travel, record.sample_period_s);
  signals.disturbance = observe_disturbance(record, design, data);
  return signals;
}

double friction_effort(const Signals& signals, const SoftMean& mean, double inertia) {
  return mean.of(signals.effort) - inertia * mean.of_slope(signals.speed) / signals.period_s;
}

/// Standard error from the scatter of five parts of the interval, each averaged like the whole. Errors at the ends of
/// the parts cancel in the whole, so this is rather too large.
double standard_error(const Signals& signals, const ConstantSpeed& stretch, double inertia) {
  constexpr std::size_t kParts = 5;
  const std::size_t span = (stretch.end - stretch.begin) / kParts;
  if (span < 8) return 0.0;
  double sum = 0.0, squares = 0.0;
  for (std::size_t part = 0; part < kParts; ++part) {
    const std::size_t begin = stretch.begin + part * span;
    const double effort = friction_effort(signals, SoftMean(begin, begin + span, 0.0), inertia);
    sum += effort;
    squares += effort * effort;
  }
  constexpr double n = kParts;
  return std::sqrt(std::max(0.0, squares - sum * sum / n) / (n - 1.0) / n);
}

double root_mean_square(const std::vector<double>& signal, const ConstantSpeed& stretch) {
  double sum = 0.0;
  for (std::size_t k = stretch.begin; k < stretch.end; ++k) sum += signal[k] * signal[k];
  return std::sqrt(sum / static_cast<double>(stretch.end - stretch.begin));
}

}  // namespace

bool FrictionPoint::is_steady() const {
  constexpr double kDeviations = 2.0;  // then the speed is opposite to the jog for at most 2 % of the time
  return std::abs(speed) > kDeviations * jitter;
}

std::vector<double> observe_disturbance(const Record& record, const AxisDesign& design, const sim::DataSheet& data) {
  const Eigen::Matrix3d correction = Eigen::Matrix3d::Identity() - design.Kobs * design.model.C;
  const Eigen::Matrix3d A = correction * design.model.A;
  const Eigen::Vector3d B = correction * design.model.B;
  const bool two = design.Kobs.cols() == 2;
  const std::vector<double> effort = motor_effort(record, data);
  const double per_volt = design.axis.effort_per_volt;

  // The position is relative to the first sample, so that the resolution of the observer does not depend on where the
  // axis is.
  Eigen::Vector3d state = Eigen::Vector3d::Zero();
  std::vector<double> disturbance(record.size());
  for (std::size_t k = 1; k < record.size(); ++k) {
    state = (A * state + B * (effort[k - 1] / per_volt)).eval();
    state += design.Kobs.col(0) * (record.x[k] - record.x[0]);
    if (two) state += design.Kobs.col(1) * record.w[k];
    disturbance[k] = state(2);
  }
  return disturbance;
}

std::vector<FrictionPoint> friction_points(const std::vector<Record>& records, const sim::DataSheet& data,
                                           const AxisDesign& design, const ConstantSpeedOptions& options) {
  std::vector<FrictionPoint> points;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Record& record = records[r];
    const Signals signals = signals_of(record, design, data);
    for (const ConstantSpeed& stretch : find_constant_speeds(record, data, options)) {
      const double samples_per_turn = data.kind == sim::DriveKind::rotary
                                          ? 2.0 * std::numbers::pi / (std::abs(stretch.speed) * record.sample_period_s)
                                          : 0.0;
      const SoftMean mean(stretch.begin, stretch.end, samples_per_turn);
      FrictionPoint point;
      point.record = r;
      point.start_s = record.t_s[stretch.begin];
      point.duration_s = record.sample_period_s * static_cast<double>(mean.length());
      point.turns = mean.turns();
      point.speed = signals.travel.empty() ? mean.of(signals.speed) : mean.of_slope(signals.travel) / signals.period_s;
      point.effort = friction_effort(signals, mean, design.axis.inertia);
      point.jitter = root_mean_square(signals.jitter, stretch);
      point.standard_error = standard_error(signals, stretch, design.axis.inertia);
      if (!signals.disturbance.empty()) {
        point.observed_effort =
            design.axis.effort_per_volt * mean.of(signals.disturbance) + design.axis.viscous * point.speed;
      }
      points.push_back(point);
    }
  }
  return points;
}

}  // namespace host
