// Whether records that were homed one by one share their zero, as far as what repeats along the travel shows it.
#pragma once

#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct AnotherZero {
  std::size_t record = 0;     ///< whose zero differs
  std::size_t reference = 0;  ///< from this one's, which shows the pattern best
  double shift = 0.0;         ///< to add to its position, mm or m; a whole number of `period` more would do as well
  double period = 0.0;        ///< the longest that stands out of both records, mm or m
};

/// Holds what a rigid axis leaves of each record's effort against its travel. Where one period and its orders stand out
/// of two records alike in size but not in phase, their zeros differ. Records without such a period, or too short to
/// show it four times, say nothing.
std::vector<AnotherZero> other_zeros(const std::vector<const Record*>& records, const sim::DataSheet& data);

}  // namespace host
