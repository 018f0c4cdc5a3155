#include "host/identify/force_estimate.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "host/dense_solutions.hpp"
#include "host/exit_codes.hpp"
#include "host/identify/inverse_model.hpp"
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
  const Eigen::Vector3d behind = square_solution(Eigen::Matrix3d::Identity() - memory, rest * design.model.W.col(1));
  found.delay_s = behind(2) * data.sample_period_s;
  return found;
}

namespace {

const std::vector<double>& column_of(const Record& record, std::string_view name) {
  const auto found = std::ranges::find(record.extra, name, &ExtraChannel::name);
  if (found == record.extra.end())
    throw Failure(ExitCode::bad_input, fmt::format("{}: a process force needs the column {}", record.path, name));
  return found->values;
}

/// Disturbance that the model explains, V: its friction and its loads at the reference.
std::vector<double> known_disturbance_V(const Record& record, const sim::DriveDescription& model) {
  const RigidAxis axis = rigid_axis(model);
  Motion reference;
  reference.t_s = record.t_s;
  reference.travel = record.x;
  reference.speed = record.w_ref;
  reference.acceleration.assign(record.size(), 0.0);
  reference.effort.assign(record.size(), 0.0);
  std::vector<double> known = inverse_effort(sim::Drive(model), reference);
  for (std::size_t k = 0; k < known.size(); ++k)
    known[k] = (known[k] - axis.viscous * record.w_ref[k]) / axis.effort_per_volt;
  return known;
}

}  // namespace

void add_process_force(Record& record, const sim::DriveDescription& model,
                       const Eigen::Matrix<double, 3, Eigen::Dynamic>& Kobs) {
  const std::vector<double>&estimate_V = column_of(record, "d_hat_V"), &covered_V = column_of(record, "u_friction_V");
  if (record.x.empty() || record.w_ref.empty())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: a process force needs the position and the reference speed", record.path));
  AxisDesign design = design_axis(model, {});
  design.Kobs = Kobs;
  const ForceEstimate stated = force_estimate(design, model.data);
  const std::vector<double> known_V = known_disturbance_V(record, model);
  ExtraChannel force{kProcessForce, std::vector<double>(record.size()), {}};
  const double periods_a_row = std::max(1.0, std::round(record.sample_period_s / model.data.sample_period_s));
  // The estimate in row k is that of the previous period, whose feed-forward used the reference of row k. Where the
  // rows leave out that period, the reference is interpolated; its feed-forward jumps where it reverses.
  const auto covered_before_V = [&](std::size_t k) {
    if (k == 0) return covered_V[0];
    const double speed = record.w_ref[k] + (record.w_ref[k - 1] - record.w_ref[k]) / periods_a_row;
    if ((record.w_ref[k] > 0.0) == (record.w_ref[k - 1] > 0.0))
      return covered_V[k] + (covered_V[k - 1] - covered_V[k]) / periods_a_row;
    return (speed > 0.0) == (record.w_ref[k] > 0.0) ? covered_V[k] : covered_V[k - 1];
  };
  for (std::size_t k = 0; k < record.size(); ++k)
    force.values[k] = stated.newton_per_V * (estimate_V[k] + covered_before_V(k) - known_V[k]);
  record.extra.push_back(std::move(force));
  record.header[kProcessForceBand] = fmt::format("{:.4g}", stated.band_N);
  record.header[kProcessForceDelay] = fmt::format("{:.4g}", stated.delay_s);
}

}  // namespace host
