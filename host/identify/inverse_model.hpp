// The inverse model: the motor torque or force needed for a measured motion.
#pragma once

#include <vector>

#include "host/identify/motion.hpp"
#include "host/record/record.hpp"
#include "sim/drive.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Whether a drive has a complete inverse model: no effect with memory (backlash, bristles, compliance, friction
/// memory, dwell, lag of a current loop), no limit of the torque and no encoder error. Tachometer errors do not matter.
bool has_inverse(const sim::Drive& drive);

/// Torque or force that the model needs for the motion, sample by sample at the full rate: J dw/dt plus friction minus
/// loads, with every effect that depends on speed, travel or time. Effects without an inverse are left out.
std::vector<double> inverse_effort(const sim::Drive& drive, const Motion& motion);

/// norm(residual) / norm(motor torque or force) on the samples of this record's regression, after the effects of the
/// command path (converter, delay, torque constant along the travel). 0 is perfect; 1 is no better than no model.
/// Throws Failure(bad_input) if no sample can be used, or if the model has no inertia.
double relative_error(const sim::DriveDescription& model, const Record& record, const MotionOptions& options = {});

/// The same over several records together.
double relative_error(const sim::DriveDescription& model, const std::vector<Record>& records,
                      const MotionOptions& options = {});

}  // namespace host
