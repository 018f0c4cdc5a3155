// Finds rows that two records share: a file given twice, or a stretch that both contain.
#pragma once

#include <cstddef>
#include <vector>

#include "host/record/record.hpp"

namespace host {

struct RecordOverlap {
  std::size_t rows = 0;  ///< rows of the second record that are also in the first
  double begin_s = 0.0;  ///< time of the first of them in the second record
  bool whole = false;    ///< the second record has no other rows
};

/// Looks for stretches of at least a tenth of a second and 50 rows in which command, position and speed are equal to
/// the last digit and the axis moves. Two runs of the same motion differ by noise and encoder steps.
RecordOverlap record_overlap(const Record& first, const Record& second);

}  // namespace host
