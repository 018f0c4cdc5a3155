// Rows that two records have in common: a file given twice, or a stretch that stands in both.
#pragma once

#include <cstddef>
#include <vector>

#include "host/record/record.hpp"

namespace host {

struct RecordOverlap {
  std::size_t rows = 0;  ///< of the second record that stand in the first as well
  double begin_s = 0.0;  ///< time of the first of them in the second record
  bool whole = false;    ///< the second record has no other rows
};

/// Looks for stretches of a tenth of a second or more, 50 rows at least, in which command, position and speed are the
/// same to the last digit and the axis moves. Two runs of one motion differ by noise and by the encoder's steps.
RecordOverlap record_overlap(const Record& first, const Record& second);

}  // namespace host
