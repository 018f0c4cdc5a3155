// Channels that say what another channel should say: exchanged, or the same thing twice.
#pragma once

#include <optional>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Whether the column of the speed holds the position and the other way round: the change of "speed" follows
/// "position", and the change of "position" does not follow "speed".
bool position_and_speed_swapped(const Record& record);

struct ScaledCopy {
  std::vector<double> Record::*channel;
  std::vector<double> Record::*original;
  double factor;
  bool harmless;  ///< the analysis does not need the copy: a current that only repeats the command
};

/// The first channel that is another one times a constant, plus a constant, to a thousandth of its own size or (what
/// a reference could follow, too) exactly. Channels that do not vary are no copies.
std::optional<ScaledCopy> scaled_copy(const Record& record);

/// Whether the speed is the difference of the position from row to row, or over two rows, to the last digit.
bool speed_is_differenced(const Record& record, const sim::DataSheet& data);

}  // namespace host
