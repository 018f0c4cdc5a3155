// Runs a planned path on a board: streams its nodes ahead of the motion, and records the encoders.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <vector>

#include "firmware/core/path/probe_watch.hpp"
#include "host/device/board_client.hpp"
#include "host/device/capture_channels.hpp"
#include "host/path/path_words.hpp"
#include "host/record/record.hpp"

namespace host {

/// Values of the axes that a path needs, from a board's parameters.
struct PathBoard {
  PathScale scale;
  AxisLimits limits;
  PathPoint least, most;  ///< soft limits, mm
  PathPoint home;         ///< homing.position, mm
};
/// `metres`: mask of the axes whose parameters are in m (linear drives).
PathBoard path_board(const firmware::ParameterValues& values, std::size_t axes, unsigned metres = 0,
                     bool needs_fitted = true);

/// The operator's commands, polled some fifty times a second.
struct PathWish {
  bool held = false;  ///< feed hold
  bool stop = false;
  int permille = 1000;  ///< override, per mille of the planned speed
  bool resume = false;  ///< continue if the program waits for the operator
};

struct PathProgress {
  firmware::PathStatePayload state;
  double elapsed_s = 0.0;           ///< time of the plan
  const PathStop* waits = nullptr;  ///< stop at which the program waits, at rest, for the operator; else null
};

/// What the process force of an axis is computed from, row by row.
struct PathForceRows {
  std::vector<double> w_ref;  ///< rad/s (m/s)
  std::vector<double> d_hat_V, u_friction_V;
};

/// Encoders and references, row by row.
struct PathCapture {
  double row_period_s = 0.0;
  std::vector<std::uint32_t> number;                  ///< of each row; a jump means lost rows
  std::vector<double> u_V;                            ///< of the first axis
  std::vector<std::vector<double>> mm, reference_mm;  ///< of each axis
  std::vector<PathForceRows> force;                   ///< of the first axes, as many as were asked for
  std::size_t lost = 0;
  std::uint32_t dropped_by_board = 0;
};

/// Number of process forces for which a row of this many axes has room.
std::size_t most_path_forces(std::size_t axes);

/// Records the axes from the first path that uses it, through all further paths and the rests between them.
class PathRecorder {
 public:
  /// `forces`: number of the first axes whose process force is recorded too, at most most_path_forces(); the rows then
  /// come at most 500 times a second instead of 1000.
  PathRecorder(BoardClient& board, const PathBoard& machine, std::size_t forces = 0);
  PathRecorder(const PathRecorder&) = delete;
  PathRecorder& operator=(const PathRecorder&) = delete;
  ~PathRecorder();  ///< ends the board's capture

  /// Starts the capture; does nothing if it runs.
  void start();
  /// Takes the rows that have arrived; if there are none, waits for them, at most `patience`. False if none arrived.
  bool fetch(std::chrono::milliseconds patience);
  /// Ends the capture and takes all rows that the board has sent.
  void stop();
  const PathCapture& capture() const { return capture_; }

 private:
  BoardClient& board_;
  PathCapture capture_;
  std::vector<double> unit_mm_;
  firmware::CaptureRequest request_;
  std::vector<std::size_t> order_;  ///< of the words in a row
  std::vector<ChannelScale> scales_;
  std::size_t first_ = 0;
  bool runs_ = false;
};

struct PathOutcome {
  firmware::PathStatePayload state;
  double clock_s = 0.0;  ///< duration from start to rest on the board's clock, from the recorder's rows
};

/// References of enabled axes at rest, where a path must begin. Opens a path on the board; may be called again.
std::vector<BoardPosition> path_start(BoardClient& board, const PathScale& scale, bool relative);

/// Follows the path from its beginning to rest, or until the probe reaches the expected state. However it ends, the
/// board is stopped. Throws what BoardClient throws, and Failure(refused) naming the node that the board refuses.
PathOutcome run_path(BoardClient& board, const PlannedPath& path, const PathBoard& scale, bool relative,
                     PathRecorder& recorder, const std::function<PathWish(const PathProgress&)>& follow,
                     firmware::ProbeStop probe = firmware::ProbeStop::none);

/// Position of the probe's edge on the last path, mm of each axis; empty if there was none. Throws
/// Failure(device_fault) if the edge was not latched.
std::optional<std::vector<double>> probed_mm(BoardClient& board, const PathScale& scale);

/// Converts the capture to a record of the first axis, with the positions of the others and the contour error as
/// further columns.
Record path_record(const PathCapture& capture, const PathBoard& board, const std::vector<double>& contour_um);

/// Distance of the position by the encoders from the path, um, for the rows from `begin` to before `end`.
std::vector<double> contour_error_um(const PathCapture& capture, const PlannedPath& path, const PathScale& scale,
                                     std::size_t begin, std::size_t end);
inline std::vector<double> contour_error_um(const PathCapture& capture, const PlannedPath& path,
                                            const PathScale& scale) {
  return contour_error_um(capture, path, scale, 0, capture.number.size());
}

}  // namespace host
