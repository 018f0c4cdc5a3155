// How far a controlled axis is from its reference, as its own encoder sees it.
#pragma once

#include <vector>

#include "host/record/record.hpp"

namespace host {

struct FollowingError {
  double rms_um = 0.0, largest_um = 0.0;
};

/// Rows of a record between the first and the last motion of its reference.
struct MovingRows {
  std::size_t begin = 0, end = 0;
};
MovingRows moving_rows(const Record& record);

/// Reference less encoder, µm, of the moving rows; an encoder's step is taken at its middle. Throws Failure(bad_input)
/// for a record without a reference or without motion.
std::vector<double> following_um(const Record& record, const sim::DataSheet& data);
FollowingError following_error(const Record& record, const sim::DataSheet& data);

/// What the same motion made twice does not repeat, µm RMS of one of them: no parameter can mend that.
double following_floor_um(const Record& once, const Record& again);

}  // namespace host
