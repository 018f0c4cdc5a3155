// Finds rows that two records have in common: a file given twice, or an interval that both contain.
#pragma once

#include <cstddef>
#include <vector>

#include "host/record/record.hpp"

namespace host {

struct RecordOverlap {
  std::size_t rows = 0;  ///< rows of the second record that are also in the first
  double begin_s = 0.0;  ///< time of the first of them in the second record
  bool whole = false;    ///< all rows of the second record are in the first
};

/// Finds intervals of at least a tenth of a second and 50 rows in which the axis moves and command, position and speed
/// are exactly equal. Two runs of the same motion differ by noise and encoder steps.
RecordOverlap record_overlap(const Record& first, const Record& second);

}  // namespace host
