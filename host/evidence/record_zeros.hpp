// Checks that records that were homed separately share their zero, by patterns that repeat along the travel.
#pragma once

#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct AnotherZero {
  std::size_t record = 0;     ///< whose zero differs
  std::size_t reference = 0;  ///< from this one's, which shows the pattern best
  double shift = 0.0;         ///< to add to its position, mm or m; unknown by whole multiples of `period`
  double period = 0.0;        ///< longest significant period of both records, mm or m
};

/// Analyses the residual of a rigid model over the travel. If a period and its orders are significant in two records
/// with equal amplitude but different phase, their zeros differ. Records without such a period, or with less than four
/// periods of travel, give no answer.
std::vector<AnotherZero> other_zeros(const std::vector<const Record*>& records, const sim::DataSheet& data);

}  // namespace host
