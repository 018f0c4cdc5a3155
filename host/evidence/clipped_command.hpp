// Finds a command that the log clips although the amplifier did not.
#pragma once

#include <optional>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct ClippedCommand {
  double level_V;  ///< largest command in the log
  double share;    ///< of the rows at that level
  double excess;   ///< torque or force that the motion needed there over that level, minus 1
  double t_s;      ///< time of the first such row
};

/// Finds a command that stays at its largest value, below the converter's limit, while the motion needs a larger
/// command. Inertia and friction come from the rows below that value. A limit of the drive (current, voltage, dead
/// zone) makes the torque smaller than the command and never larger, so it is not mistaken for clipping.
std::optional<ClippedCommand> clipped_command(const Record& record, const sim::DriveDescription& model);

}  // namespace host
