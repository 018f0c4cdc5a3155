// Converts a design to the parameters of the control core.
#pragma once

#include "firmware/core/axis_parameters.hpp"
#include "host/parameters/board_parameters.hpp"
#include "host/parameters/control_filters.hpp"

namespace host {

/// Parameters of an axis that runs `design`, with the friction curve of `model` (whose viscous part beyond the design's
/// own B is none: both are the model's). All switches are off. `tachometer_resolution`: rad/s (m/s) a code of the
/// board.
firmware::AxisParameters<float> axis_parameters(const sim::DriveDescription& model, const AxisDesign& design,
                                                double tachometer_resolution, const ReferenceLimits& limits = {});

/// The same as on a board after `design` and `set-params`: with the switches of board_parameters().
firmware::AxisParameters<float> designed_parameters(const sim::DriveDescription& model, const AxisDesign& design,
                                                    const ControlFilterChoice& filters = {});

}  // namespace host
