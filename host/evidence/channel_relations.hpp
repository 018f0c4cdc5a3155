// Finds channels that contradict or repeat another channel: exchanged columns and copies.
#pragma once

#include <optional>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Whether the columns of speed and position are exchanged: the change of "speed" follows "position", but the change of
/// "position" does not follow "speed".
bool position_and_speed_swapped(const Record& record);

struct ScaledCopy {
  std::vector<double> Record::*channel;
  std::vector<double> Record::*original;
  double factor;
  bool harmless;  ///< the analysis does not need the channel: a current that only repeats the command
};

/// The first channel that equals another one times a constant plus a constant. It must do so to a thousandth of its own
/// size, or exactly if it could be a reference that the axis follows as closely, or, for a current and its command, to
/// the rounding of both. Constant channels are not copies.
std::optional<ScaledCopy> scaled_copy(const Record& record);

/// Whether the speed is exactly the difference of positions over one or two rows.
bool speed_is_differenced(const Record& record, const sim::DataSheet& data);

}  // namespace host
