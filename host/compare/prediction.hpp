// What a model predicts of a record from the recorded command alone, over short windows that restart from the smoothed
// measured state: free runs drift, and a drift tells little about what is wrong.
#pragma once

#include <cstddef>
#include <vector>

#include "host/evidence/prepared_record.hpp"
#include "sim/drive.hpp"

namespace host {

/// Predicted channels, one value a row; rows that no window reaches are left as they were.
struct Prediction {
  std::vector<double> x;  ///< what the encoder would read, without quantisation
  std::vector<double> w;  ///< what the tachometer would read, without noise
};

/// Predicts every `stride`-th window. `out` is resized when needed, so that it can be used again.
void predict(const sim::Drive& drive, const PreparedRecord& prepared, Prediction& out, std::size_t stride = 1);

/// The restart states of all windows: hidden states follow the record's motion from its start.
std::vector<sim::DriveState> restart_states(const sim::Drive& drive, const PreparedRecord& prepared);

}  // namespace host
