// Finds a command that the log cuts off although the amplifier did not.
#pragma once

#include <optional>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct ClippedCommand {
  double level_V;  ///< largest command in the log
  double share;    ///< of the rows at that level
  double excess;   ///< relative excess of the torque or force that the motion needed there over the level
  double t_s;      ///< of the first such row
};

/// Finds a command that stays at one largest level below the converter's limit while the axis moves as only a larger
/// command can explain. Inertia and friction come from the rows below that level. A limit of the drive (current,
/// voltage, dead zone) reduces the torque below the command and never raises it, so it is not mistaken for clipping.
std::optional<ClippedCommand> clipped_command(const Record& record, const sim::DriveDescription& model);

}  // namespace host
