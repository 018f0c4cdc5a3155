// What the best possible model would leave: sensor noise, quantisation, and the uncertainty of the restart state
// carried through the model, window by window.
#pragma once

#include <vector>

#include "host/compare/prediction.hpp"
#include "sim/drive.hpp"

namespace host {

/// RMS floors of one record, one element a window; a channel that the record lacks is empty.
struct ErrorFloor {
  std::vector<double> x;
  std::vector<double> w;
};

ErrorFloor error_floor(const sim::Drive& drive, const sim::DataSheet& data, const PreparedRecord& prepared);

}  // namespace host
