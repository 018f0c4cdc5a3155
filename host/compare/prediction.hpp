// Prediction of a record by its command alone, over short windows. Each window restarts from the smoothed measured
// state, because a free run drifts and its drift shows little about the cause.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/evidence/prepared_record.hpp"
#include "sim/drive.hpp"

namespace host {

/// Predicted channels, one value per row; rows outside all windows are not changed.
struct Prediction {
  std::vector<double> x;      ///< encoder reading without quantisation
  std::vector<double> w;      ///< tachometer reading without noise
  std::vector<double> table;  ///< travel of the table; empty if the record has none
};

/// Predicts every `stride`-th window. `out` is resized if needed, so it can be reused.
void predict(const sim::Drive& drive, const PreparedRecord& prepared, Prediction& out, std::size_t stride = 1);

/// The restart states of every `stride`-th window. Hidden states follow the motion of the record from its start.
std::vector<sim::DriveState> restart_states(const sim::Drive& drive, const PreparedRecord& prepared,
                                            std::size_t stride = 1);

/// One window that a drive predicts from its own state. The sensor readings are written to `x` and `w`, which must have
/// the length of the window; the travel of the table is written to `table`, if it is set.
struct WindowRun {
  const Window* window;
  sim::DriveState state;
  double* x;
  double* w;
  double* table = nullptr;
};

/// Several runs are interleaved, because the processor can overlap independent calculations. This doubles the speed.
inline constexpr std::size_t kSideBySide = 4;

/// Performs up to kSideBySide runs of the same record.
void run_side_by_side(const sim::Drive& drive, const PreparedRecord& prepared, std::span<WindowRun> runs);

}  // namespace host
