#include "host/identify/friction_points.hpp"

#include <algorithm>
#include <cmath>

#include "host/identify/motion.hpp"

namespace host {

namespace {

/// Standard error of a mean whose samples are correlated, from the scatter of ten batches' means.
double standard_error_of_mean(const std::vector<double>& signal, std::size_t begin, std::size_t end) {
  constexpr std::size_t kBatches = 10;
  const std::size_t length = std::max<std::size_t>(1, (end - begin) / kBatches);
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (std::size_t start = begin; start + length <= end; start += length) {
    double mean = 0.0;
    for (std::size_t k = start; k < start + length; ++k) mean += signal[k];
    mean /= static_cast<double>(length);
    sum += mean;
    squares += mean * mean;
    count += 1.0;
  }
  if (count < 2.0) return 0.0;
  const double variance = std::max(0.0, squares - sum * sum / count) / (count - 1.0);
  return std::sqrt(variance / count);
}

double mean_of(const std::vector<double>& signal, std::size_t begin, std::size_t end) {
  double sum = 0.0;
  for (std::size_t k = begin; k < end; ++k) sum += signal[k];
  return sum / static_cast<double>(end - begin);
}

}  // namespace

std::vector<double> observe_disturbance(const Record& record, const AxisDesign& design, const sim::DataSheet& data) {
  const Eigen::Matrix3d correction = Eigen::Matrix3d::Identity() - design.Kobs * design.model.C;
  const Eigen::Matrix3d A = correction * design.model.A;
  const Eigen::Vector3d B = correction * design.model.B;
  const bool two = design.Kobs.cols() == 2;
  const std::vector<double> effort = motor_effort(record, data);
  const double per_volt = design.axis.effort_per_volt;

  // Position counts from the first sample: the observer's own resolution then does not depend on where the axis is.
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
    const std::vector<double> effort = motor_effort(record, data);
    const std::vector<double> disturbance =
        record.has_position() ? observe_disturbance(record, design, data) : std::vector<double>{};
    for (const ConstantSpeed& stretch : find_constant_speeds(record, data, options)) {
      FrictionPoint point;
      point.record = r;
      point.start_s = record.t_s[stretch.begin];
      point.duration_s = record.sample_period_s * static_cast<double>(stretch.end - stretch.begin);
      point.turns = stretch.turns;
      point.speed = stretch.speed;
      point.effort = mean_of(effort, stretch.begin, stretch.end) - design.axis.inertia * stretch.acceleration;
      point.standard_error = standard_error_of_mean(effort, stretch.begin, stretch.end);
      if (!disturbance.empty()) {
        point.observed_effort = design.axis.effort_per_volt * mean_of(disturbance, stretch.begin, stretch.end) +
                                design.axis.viscous * stretch.speed;
      }
      points.push_back(point);
    }
  }
  return points;
}

}  // namespace host
