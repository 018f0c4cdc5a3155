// The inverse model: which effort the motor must have given for a motion that was measured.
#pragma once

#include <vector>

#include "host/identify/motion.hpp"
#include "host/record/record.hpp"
#include "sim/drive.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Whether all that acts in a drive shows in its inverse model: nothing that remembers (backlash, bristles, compliance,
/// friction memory, dwell, a current loop's lag), limits the effort or errs at the encoder. A tachometer's errors do
/// not matter to it.
bool has_inverse(const sim::Drive& drive);

/// Effort that the model needs for the motion, sample by sample at full rate: J dw/dt plus friction minus loads, with
/// every effect that depends on speed, travel or time; what has no inverse is left out.
std::vector<double> inverse_effort(const sim::Drive& drive, const Motion& motion);

/// norm(residual) / norm(motor effort) over what the regression of this record would see, after the command's own
/// effects (converter, delay, torque constant along the travel). 0 is perfect; 1 is no better than no model.
/// Throws Failure(bad_input) where no sample counts, or the model has no inertia.
double relative_error(const sim::DriveDescription& model, const Record& record, const MotionOptions& options = {});

/// The same over several records together.
double relative_error(const sim::DriveDescription& model, const std::vector<Record>& records,
                      const MotionOptions& options = {});

}  // namespace host
