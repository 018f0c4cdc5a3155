// Following error of a controlled axis, measured by its own encoder.
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

/// Reference minus encoder, µm, of the moving rows; an encoder count is taken at the middle of its step. Throws
/// Failure(bad_input) for a record without a reference or without motion.
std::vector<double> following_um(const Record& record, const sim::DataSheet& data);
FollowingError following_error(const Record& record, const sim::DataSheet& data);

/// The non-repeatable part of the following error of one motion, µm RMS, from two runs; no parameter can reduce it.
double following_floor_um(const Record& once, const Record& again);

}  // namespace host
