// What a model predicts of a record from the recorded command alone, over short windows that restart from the smoothed
// measured state: free runs drift, and a drift tells little about what is wrong.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "host/insight/smoothed_motion.hpp"
#include "host/record/record.hpp"
#include "sim/drive.hpp"

namespace host {

/// Restarts at row `begin` and predicts rows begin+1 ... begin+length.
struct Window {
  std::size_t begin;
  std::size_t length;
};

/// Length of a window, s: long enough for an effect to move the axis, short enough that a drive whose friction falls
/// with speed (errors grow by some 50 /s) does not carry a restart's uncertainty into everything.
inline constexpr double kWindow_s = 0.1;

/// A record made ready for comparison. Refers to the record, which must outlive it.
struct PreparedRecord {
  const Record* record;
  std::vector<double> u_V;
  MotionSmoother smoother;
  std::vector<Window> windows;
  double period_s;
  std::shared_ptr<const std::vector<ShiftWeights>> shift_weights;  ///< of every window that the record has room for

  const SmoothedMotion& motion() const { return smoother.motion(); }
  double window_s() const {
    return windows.empty() ? kWindow_s : static_cast<double>(windows.front().length) * period_s;
  }
  const ShiftWeights& weights_of(const Window& window) const { return (*shift_weights)[window.begin / window.length]; }
};

/// `base` gives the inertia and viscous friction that the smoother needs. Throws Failure(bad_input) for a record
/// without a command, or shorter than one window.
PreparedRecord prepare(const Record& record, const sim::DriveDescription& base, double window_s = kWindow_s);

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
