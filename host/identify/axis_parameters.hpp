// A design in the form that the control core takes.
#pragma once

#include "firmware/core/axis_parameters.hpp"
#include "host/identify/axis_design.hpp"

namespace host {

/// Limits of references, mm (rotary) or m (linear) per s, s^2, s^3. Defaults: the paper, p. 1508 (in mm; its feed of
/// 170 mm/s with room to spare).
struct ReferenceLimits {
  double velocity = 250.0;
  double acceleration = 2000.0;
  double jerk = 50000.0;
};

/// Parameters of an axis that runs `design`, with the friction curve of `model` (whose viscous part beyond the design's
/// own B is none: both are the model's). All switches are off. `tachometer_resolution`: rad/s (m/s) a code of the
/// board.
firmware::AxisParameters<float> axis_parameters(const sim::DriveDescription& model, const AxisDesign& design,
                                                double tachometer_resolution, const ReferenceLimits& limits = {});

}  // namespace host
