// Converts a design to the parameters of the control core, and the estimator back.
#pragma once

#include "firmware/app/parameters/parameter_values.hpp"
#include "firmware/core/axis_parameters.hpp"
#include "host/parameters/board_parameters.hpp"
#include "host/parameters/control_filters.hpp"

namespace host {

/// Parameters of an axis that runs `design`, with the friction curve of `model`. The curve has no viscous part, because
/// the design already includes the model's B. All switches are off. `tachometer_resolution`: rad/s (m/s) per code of
/// the board.
firmware::AxisParameters<float> axis_parameters(const sim::DriveDescription& model, const AxisDesign& design,
                                                double tachometer_resolution, const ReferenceLimits& limits = {});

/// The same with the switches of board_parameters(), as on a board after `design` and `set-params`. Without `limits`:
/// the usual ones.
firmware::AxisParameters<float> designed_parameters(const sim::DriveDescription& model, const AxisDesign& design,
                                                    const ControlFilterChoice& filters = {},
                                                    const std::optional<ReferenceLimits>& limits = {});

/// The estimator of a board's axis, Kobs of a design.
Eigen::Matrix<double, 3, Eigen::Dynamic> estimator_of(const firmware::AxisValues& board);

}  // namespace host
