#include "host/identify/linear_axis.hpp"

#include <fmt/format.h>

#include "host/dense_solutions.hpp"
#include "host/exit_codes.hpp"

namespace host {

double newton_per_volt(const RigidAxis& axis, sim::DriveKind kind) {
  const double metres = kind == sim::DriveKind::linear ? 1.0 : 1e-3;
  return axis.effort_per_volt / (axis.lead * metres);
}

RigidAxis rigid_axis(const sim::DriveDescription& model) {
  const sim::EffectEntry* inertia = model.find("inertia");
  if (inertia == nullptr || !inertia->has("J") || !(inertia->at("J") > 0.0)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("model '{}': no positive inertia; add an [[effect]] of kind \"inertia\", or make a model "
                              "with: axistool identify RECORD --drive DRIVE.toml -o MODEL",
                              model.name));
  }
  RigidAxis axis;
  axis.inertia = inertia->at("J");
  const sim::EffectEntry* viscous = model.find("viscous");
  axis.viscous = viscous != nullptr && viscous->has("B") ? viscous->at("B") : 0.0;
  axis.effort_per_volt = model.data.effort_per_volt();
  axis.lead = model.data.lead;
  if (!(axis.effort_per_volt > 0.0)) {
    throw Failure(ExitCode::bad_input, fmt::format("model '{}': [drive] needs {} greater than zero", model.name,
                                                   model.data.kind == sim::DriveKind::rotary
                                                       ? "torque_constant_Nm_per_A"
                                                       : "force_constant_N_per_V or force_constant_N_per_A"));
  }
  return axis;
}

SampledAxis sample_axis(const RigidAxis& axis, double sample_period_s) {
  // The exponential of [Ac Bc; 0 0]*Ts contains Ad and Bd side by side, without a special case at pw = 0.
  Eigen::Matrix3d held = Eigen::Matrix3d::Zero();
  held(0, 1) = axis.lead;
  held(1, 1) = axis.pole();
  held(1, 2) = axis.gain();
  const Eigen::Matrix3d sampled = exponential(held * sample_period_s);
  return {sampled.topLeftCorner<2, 2>(), sampled.topRightCorner<2, 1>()};
}

AugmentedAxis augment_axis(const SampledAxis& axis, bool has_tachometer) {
  AugmentedAxis augmented;
  augmented.A.setIdentity();
  augmented.A.topLeftCorner<2, 2>() = axis.Ad;
  augmented.A.topRightCorner<2, 1>() = -axis.Bd;
  augmented.B << axis.Bd, 0.0;
  augmented.W.setZero();
  augmented.W.topLeftCorner<2, 1>() = axis.Bd;
  augmented.W(2, 1) = 1.0;
  augmented.C.setIdentity(has_tachometer ? 2 : 1, 3);
  return augmented;
}

}  // namespace host
