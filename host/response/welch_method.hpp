// Welch's method: averages over overlapping segments of any record.
#pragma once

#include <vector>

#include "host/response/frequency_response.hpp"

namespace host {

struct WelchResponse {
  bool is_indirect = false;
  std::size_t stretches = 0;
  std::vector<ResponseLine> lines;  ///< those with significant coherence (95 %)
};

/// Hann windows with half overlap; G = S_yr / S_ur with r the reference's speed if it moves, else the command.
/// Intervals after Bendat & Piersol, Random Data, 4th ed., 9.2. Uses the increments of the position, so that a jog does
/// not appear as a ramp.
WelchResponse welch_response(const std::vector<Record>& records);

}  // namespace host
