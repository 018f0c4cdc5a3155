// A record prepared for comparison with a model: smoothed motion, and the windows in which a prediction restarts.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "host/evidence/held_command.hpp"
#include "host/evidence/smoothed_motion.hpp"
#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// A prediction restarts at row `begin` and covers rows begin+1 ... begin+length.
struct Window {
  std::size_t begin;
  std::size_t length;
};

/// Length of a window, s. In this time an effect moves the axis enough, and the uncertainty of the restart does not yet
/// dominate, even on a drive whose friction falls with speed (errors grow by some 50 /s).
inline constexpr double kWindow_s = 0.1;

/// A record prepared for comparison. Refers to the record, which must outlive it.
struct PreparedRecord {
  const Record* record;
  std::vector<double> u_V;  ///< command_volts
  HeldCommand held;         ///< the same command, as the drive holds it
  double effort_noise;      ///< noise of one row, Nm or N; 0 for a command, which is known exactly
  std::shared_ptr<const MotionSmoother> smoother;  ///< shared by copies of a set: 200 bytes a row
  std::vector<Window> windows;
  double period_s;
  std::shared_ptr<const std::vector<ShiftWeights>> shift_weights;  ///< weights of every complete window of the record

  const SmoothedMotion& motion() const { return smoother->motion(); }
  double window_s() const {
    return windows.empty() ? kWindow_s : static_cast<double>(windows.front().length) * period_s;
  }
  /// Windows begin at multiples of their common length; only the last window may be shorter.
  const ShiftWeights& weights_of(const Window& window) const {
    return (*shift_weights)[window.begin / windows.front().length];
  }
};

/// `base` gives the inertia and viscous friction that the smoother needs. Throws Failure(bad_input) for a record
/// without a command or shorter than one window.
PreparedRecord prepare(const Record& record, const sim::DriveDescription& base, double window_s = kWindow_s);

/// The same record with consecutive windows joined to windows of `window_s`, if those are longer. Windows without all
/// of their neighbours are dropped.
PreparedRecord in_long_windows(PreparedRecord prepared, double window_s);

}  // namespace host
