// A command that the log cuts off where the amplifier did not.
#pragma once

#include <optional>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct ClippedCommand {
  double level_V;  ///< largest command in the log
  double share;    ///< of the rows at that level
  double excess;   ///< part by which the motion there needed more effort than the level gives
  double t_s;      ///< of the first such row
};

/// Finds a command that stays at one largest level below the converter's limit while the axis does there what more
/// effort alone could do, judged by inertia and friction as the rows below that level show them. A limit of the drive
/// (current, voltage, dead zone) gives less effort than was commanded, never more, and is not mistaken for it.
std::optional<ClippedCommand> clipped_command(const Record& record, const sim::DriveDescription& model);

}  // namespace host
