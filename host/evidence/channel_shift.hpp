// Finds channels that were logged early or late by more than a lag of the drive or a sensor explains.
#pragma once

#include <optional>

#include "host/identify/motion.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// prepare_motion(); empty where the record is too short for the filter, or its command is not known as an effort.
std::optional<Motion> motion_if_long_enough(const Record& record, const sim::DataSheet& data,
                                            const MotionOptions& options);

/// Samples by which the tachometer lags (> 0) or leads (< 0) the encoder. Empty without a shift, if a first-order lag
/// fits as well (that is physics), or if the shift is not a whole number of samples and leaves a larger residual than a
/// logger's shift does.
std::optional<double> tachometer_shift(const Record& record, const sim::DataSheet& data);

/// Whole samples by which the axis answers before (> 0) or after (< 0) its command, beyond what a drive can do: before
/// the command, or later than the dead times of the catalogue. Empty otherwise.
std::optional<double> command_shift(const Record& record, const sim::DriveDescription& model);

}  // namespace host
