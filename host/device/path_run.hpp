// A planned path on a board: its nodes streamed ahead of the motion, and what the encoders saw of it.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "firmware/core/path/probe_watch.hpp"
#include "host/device/board_client.hpp"
#include "host/path/path_words.hpp"
#include "host/record/record.hpp"

namespace host {

/// What a board's parameters say of some of its axes. Throws Failure(refused) where one is not fitted, and must be.
struct PathBoard {
  PathScale scale;
  AxisLimits limits;
  PathPoint least, most;  ///< soft limits, mm
  PathPoint home;         ///< homing.position, mm
};
/// `metres`: axes whose parameters stand in m, as a linear drive's do.
PathBoard path_board(const firmware::ParameterValues& values, std::size_t axes, unsigned metres = 0,
                     bool needs_fitted = true);

/// What the person at the machine wants, asked for some fifty times a second.
struct PathWish {
  bool held = false;  ///< feed hold
  bool stop = false;
  int permille = 1000;  ///< of the speed that was planned
  bool resume = false;  ///< goes on where the program waits for its operator
};

struct PathProgress {
  firmware::PathStatePayload state;
  double elapsed_s = 0.0;           ///< of the plan
  const PathStop* waits = nullptr;  ///< where the program waits for its operator: the axes stand there
};

/// Encoders and references, row by row.
struct PathCapture {
  double row_period_s = 0.0;
  std::vector<std::uint32_t> number;                  ///< of each row; a jump is a loss
  std::vector<double> u_V;                            ///< of the first axis
  std::vector<std::vector<double>> mm, reference_mm;  ///< of each axis
  std::size_t lost = 0;
  std::uint32_t dropped_by_board = 0;
};

struct PathOutcome {
  firmware::PathStatePayload state;
  PathCapture capture;   ///< empty unless asked for
  double clock_s = 0.0;  ///< of the board, from start to rest; by the capture's rows
};

/// Where the references of enabled, standing axes are: where a path must begin. Opens a path, which may be opened anew.
std::vector<BoardPosition> path_start(BoardClient& board, const PathScale& scale, bool relative);

/// Follows the path, from its begin to rest, or until the probe finds what it looks for. However it ends, the board is
/// told to stop. Throws what BoardClient throws, and Failure(refused) naming the node that the board refuses.
PathOutcome run_path(BoardClient& board, const PlannedPath& path, const PathBoard& scale, bool relative, bool captures,
                     const std::function<PathWish(const PathProgress&)>& follow,
                     firmware::ProbeStop probe = firmware::ProbeStop::none);

/// Where the probe found what the last path looked for, mm of each axis; empty where it did not. Throws
/// Failure(device_fault) where its edge was not latched.
std::optional<std::vector<double>> probed_mm(BoardClient& board, const PathScale& scale);

/// As a record of the first axis, with the others' positions and the contour error beside it.
Record path_record(const PathOutcome& outcome, const PathBoard& board, const std::vector<double>& contour_um);

/// Of each row: how far the encoders' point lies from the path, um.
std::vector<double> contour_error_um(const PathCapture& capture, const PlannedPath& path, const PathScale& scale);

}  // namespace host
