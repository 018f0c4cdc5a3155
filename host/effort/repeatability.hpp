// What repeats when a motion is repeated: that a model can explain. What does not is noise, whatever its size.
#pragma once

#include <optional>

#include "host/effort/effort_rows.hpp"

namespace host {

struct Repeatability {
  double share = 0.0;    ///< of the residual's square that came back, 0..1
  double floor = 0.0;    ///< RMS of what did not, Nm or N: the floor that is the machine's
  double seconds = 0.0;  ///< how much motion was compared with its repetition
};

/// The residual of every row against the residual one period of the motion later, over the records whose motion comes
/// back. Nothing where none does for two seconds in all.
std::optional<Repeatability> repeatability(const EffortRows& rows, const Eigen::VectorXd& residual);

}  // namespace host
