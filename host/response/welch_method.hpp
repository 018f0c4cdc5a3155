// Welch's method: averages over overlapping stretches of any record.
#pragma once

#include <vector>

#include "host/response/frequency_response.hpp"

namespace host {

struct WelchResponse {
  bool is_indirect = false;
  std::size_t stretches = 0;
  std::vector<ResponseLine> lines;  ///< those whose coherence is beyond chance (95 %)
};

/// Hann windows that overlap by half; G = S_yr / S_ur with r the reference's speed where it moves, else the command.
/// Intervals after Bendat & Piersol, Random Data, 4th ed., 9.2. Position enters by its increments, so that a jog is no
/// ramp.
WelchResponse welch_response(const std::vector<Record>& records);

}  // namespace host
