// Finds channels that contradict or repeat another one: exchanged columns and copies.
#pragma once

#include <optional>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Whether the columns of speed and position are exchanged: the change of "speed" follows "position", and the change of
/// "position" does not follow "speed".
bool position_and_speed_swapped(const Record& record);

struct ScaledCopy {
  std::vector<double> Record::*channel;
  std::vector<double> Record::*original;
  double factor;
  bool harmless;  ///< the analysis does not need the copy: a current that only repeats the command
};

/// The first channel that is another one times a constant plus a constant: to a thousandth of its own size, or exactly
/// if a reference could follow it as closely. Constant channels are not copies.
std::optional<ScaledCopy> scaled_copy(const Record& record);

/// Whether the speed is the difference of positions over one or two rows, to the last digit.
bool speed_is_differenced(const Record& record, const sim::DataSheet& data);

}  // namespace host
