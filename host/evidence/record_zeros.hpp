// Checks that records that were homed separately have the same zero, by patterns that repeat along the travel.
#pragma once

#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct AnotherZero {
  std::size_t record = 0;     ///< the record whose zero differs
  std::size_t reference = 0;  ///< the record with which it is compared, which shows the pattern best
  double shift = 0.0;         ///< to add to its position, mm or m; determined up to multiples of `period`
  double period = 0.0;        ///< longest significant period of both records, mm or m
};

/// Analyses the residual of a rigid model over the travel. The zeros of two records differ if a period and its orders
/// are significant in both, with equal amplitude but different phase. Records without such a period, or with less than
/// four periods of travel, are not compared.
std::vector<AnotherZero> other_zeros(const std::vector<const Record*>& records, const sim::DataSheet& data);

}  // namespace host
