// Finds channels that were logged earlier or later than a lag of the drive or of a sensor can explain.
#pragma once

#include <optional>

#include "host/identify/motion.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// prepare_motion(); empty if the record is too short for the filter or its command does not give a torque or force.
std::optional<Motion> motion_if_long_enough(const Record& record, const sim::DataSheet& data,
                                            const MotionOptions& options);

/// Samples by which the tachometer lags (> 0) or leads (< 0) the encoder. Empty if there is no shift, if a first-order
/// lag fits as well (which is physics), or if the shift is not a whole number of samples and leaves a larger residual
/// than the shift of a logger would.
std::optional<double> tachometer_shift(const Record& record, const sim::DataSheet& data);

/// Whole samples by which the motion starts before (> 0) or after (< 0) its command, if a drive cannot do that: before
/// the command, or later than the dead times of the catalogue allow. Empty otherwise.
std::optional<double> command_shift(const Record& record, const sim::DriveDescription& model);

}  // namespace host
