// Prediction of a record from its command alone, over short windows that restart from the smoothed measured state. Free
// runs drift, and a drift says little about its cause.
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
  std::vector<double> table;  ///< travel of the table; empty unless the record has it
};

/// Predicts every `stride`-th window. `out` is resized if needed, so it can be reused.
void predict(const sim::Drive& drive, const PreparedRecord& prepared, Prediction& out, std::size_t stride = 1);

/// The restart states of every `stride`-th window: hidden states follow the record's motion from its start.
std::vector<sim::DriveState> restart_states(const sim::Drive& drive, const PreparedRecord& prepared,
                                            std::size_t stride = 1);

/// One window that a drive runs through from its own state. The sensors' readings are written to `x` and `w`, which
/// must have the window's length; the table's travel to `table`, if that is given.
struct WindowRun {
  const Window* window;
  sim::DriveState state;
  double* x;
  double* w;
  double* table = nullptr;
};

/// Runs are interleaved: the processor overlaps them, where a single run would wait for its last result. This doubles
/// the speed.
inline constexpr std::size_t kSideBySide = 4;

/// Carries out some runs, up to kSideBySide of them, of the same record.
void run_side_by_side(const sim::Drive& drive, const PreparedRecord& prepared, std::span<WindowRun> runs);

}  // namespace host
