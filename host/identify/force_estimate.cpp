#include "host/identify/force_estimate.hpp"

#include <Eigen/LU>
#include <cmath>

#include "host/statistics.hpp"

namespace host {

ForceEstimate force_estimate(const AxisDesign& design, const sim::DataSheet& data) {
  const DesignOptions& used = design.used;
  const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - design.Kobs * design.model.C;
  // The error of the estimate: e(k) = (I - Kobs C)(A e(k-1) + W [u~ wd]) - Kobs [x~ w~].
  const Eigen::Matrix3d memory = rest * design.model.A;
  const Eigen::Vector3d command = rest * design.model.W.col(0);
  Eigen::VectorXd sensors(design.Kobs.cols());
  sensors(0) = used.position_variance.value_or(0.0);
  if (sensors.size() > 1) sensors(1) = used.tach_variance.value_or(0.0);
  // Sum of memory^n Q memory'^n, doubled until the power has faded.
  Eigen::Matrix3d sum = used.command_variance.value_or(0.0) * command * command.transpose() +
                        design.Kobs * sensors.asDiagonal() * design.Kobs.transpose();
  constexpr int kDoublings = 40;
  Eigen::Matrix3d power = memory;
  for (int i = 0; i < kDoublings; ++i) {
    sum += (power * sum * power.transpose()).eval();
    power = (power * power).eval();
  }
  ForceEstimate found;
  found.newton_per_V = newton_per_volt(design.axis, data.kind);
  found.band_N = kNormal95 * std::sqrt(sum(2, 2)) * found.newton_per_V;
  // For a disturbance that grows by 1 V a sample, the error in volts is the delay in samples.
  const Eigen::Vector3d behind = (Eigen::Matrix3d::Identity() - memory).lu().solve(rest * design.model.W.col(1));
  found.delay_s = behind(2) * data.sample_period_s;
  return found;
}

}  // namespace host
