// Joint fit of gap, spring, friction and drag of a driven table.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "host/infer/evidence.hpp"
#include "host/scale/driven_table.hpp"

namespace host {

/// The most probable table within bounds, fitted together with columns whose factors are free. Either all starts have a
/// gap or none has; the same holds for a spring. A gap or spring that the starts lack is not added. Levenberg-Marquardt
/// (Ceres) from the best few starts, with the noise of infer/evidence.hpp of this colour. `deceleration`: see
/// shape_ranges(). Needs at least one start.
TableDrive fit_drive(std::vector<TableDrive> starts, const TableRows& rows, const Evidence& evidence,
                     const Eigen::MatrixXd& others, const NoiseColour& colour, double deceleration);

}  // namespace host
