// Channels that were logged early or late, where no lag of the drive or of a sensor explains it.
#pragma once

#include <optional>

#include "host/identify/motion.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// prepare_motion(); empty where the record is too short for the filter, or its command is not known as an effort.
std::optional<Motion> motion_if_long_enough(const Record& record, const sim::DataSheet& data,
                                            const MotionOptions& options);

/// Samples by which the tachometer runs behind (> 0) or ahead of (< 0) the encoder. Empty where there is no shift,
/// where a first-order lag fits as well (that is physics), or where it is not a whole number of samples and leaves more
/// than such a logger does.
std::optional<double> tachometer_shift(const Record& record, const sim::DataSheet& data);

/// Whole samples by which the axis answers before (> 0) or after (< 0) its command, beyond what a drive can: an answer
/// before the command, or later than the catalogue's dead times. Empty otherwise.
std::optional<double> command_shift(const Record& record, const sim::DriveDescription& model);

}  // namespace host
