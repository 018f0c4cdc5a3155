#include "host/identify/axis_parameters.hpp"

#include "host/identify/friction_law.hpp"

namespace host {

firmware::AxisParameters<float> axis_parameters(const sim::DriveDescription& model, const AxisDesign& design,
                                                double tachometer_resolution, const ReferenceLimits& limits) {
  const auto scalar = [](double value) { return static_cast<float>(value); };
  const double effort_per_volt = design.axis.effort_per_volt;
  const FrictionLaw friction = friction_law(model);
  const auto direction = [&](const FrictionSideLaw& side) {
    return firmware::FrictionDirection<float>{scalar(side.static_level / effort_per_volt),
                                              scalar(side.coulomb / effort_per_volt), 0.0f, scalar(side.omega1),
                                              scalar(side.omega2)};
  };

  firmware::AxisParameters<float> p;
  p.sample_period_s = scalar(model.data.sample_period_s);
  p.lead = scalar(model.data.lead);
  p.encoder_resolution = scalar(model.data.encoder_resolution);
  p.dac_resolution_V = scalar(model.data.dac_resolution_V);
  p.dac_limit_V = scalar(model.data.dac_limit_V);
  p.tachometer_fitted = design.Kobs.cols() == 2;
  p.tachometer_gain = scalar(tachometer_resolution);
  p.drive = {scalar(design.model.A(0, 1)), scalar(design.model.A(1, 1)), scalar(design.model.B(0)),
             scalar(design.model.B(1))};
  for (std::size_t row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < design.Kobs.cols(); ++column) {
      p.Kobs[row][static_cast<std::size_t>(column)] = scalar(design.Kobs(static_cast<Eigen::Index>(row), column));
    }
  }
  p.Kc = {scalar(design.Kc(0)), scalar(design.Kc(1))};
  // Smoothed through zero over a hundredth of a turn a second; a hundredth of 1 mm/s for a linear drive's metres.
  const double blend = model.data.kind == sim::DriveKind::rotary ? 0.06 : 1e-4;
  p.friction = {direction(friction.positive), direction(friction.negative), scalar(blend)};
  p.velocity_limit = scalar(limits.velocity);
  p.acceleration_limit = scalar(limits.acceleration);
  p.jerk_limit = scalar(limits.jerk);
  return p;
}

}  // namespace host
