// Runs a G-code program on a board's axes: plans it, runs it (in parts if it probes), and handles the operator's keys.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/core/path/path_follower.hpp"
#include "host/axistool/device_arguments.hpp"
#include "host/device/path_run.hpp"
#include "host/gcode/program.hpp"

namespace axistool {

struct RunArguments : DeviceArguments {
  std::string file, capture;
  std::vector<std::string> linear, params, models;
  double feed_percent = 100.0, rapid_percent = 100.0;
  bool here = false, passes_stops = false;
};

struct Planned {
  host::GcodeProgram program;
  host::PlannedPath path;
};

/// Result of a probing move.
struct ProbeResult {
  host::GcodeProbe probe;
  std::size_t line = 0;    ///< of the program
  std::vector<double> mm;  ///< position of the edge for each axis; empty: no edge
};

struct ProgramOutcome {
  firmware::PathEnd end = firmware::PathEnd::completed;
  std::string failure;  ///< message if a required probing move failed
  double path_s = 0.0, planned_s = 0.0;
  double clock_s = 0.0;  ///< run time including holds, overrides and stops
  double worst_um = 0.0, squares_um2 = 0.0;
  std::size_t rows = 0, lost_rows = 0;
  std::vector<ProbeResult> probes;
};

std::string_view end_name(firmware::PathEnd end);
std::string word_of(const host::GcodeProbe& probe);
inline std::string_view sought_by(const host::GcodeProbe& probe) {
  return probe.is_away ? "loss of contact" : "contact";
}

/// `probed`: end positions of the probing moves made so far.
host::GcodeProgram read_program(const std::string& text, const RunArguments& arguments, const host::PathBoard& board,
                                const host::PathPoint& start, const std::vector<host::PathPoint>& probed);
host::PlannedPath plan_moves(const std::vector<host::PathMove>& moves, const RunArguments& arguments,
                             const host::PathBoard& board);
host::PathPoint point_of(const std::vector<host::BoardPosition>& at, const host::PathScale& scale);

/// Checks, before a program starts or continues after a stop, that the axes are homed and have no fault. Throws
/// Failure.
void require_startable(host::BoardClient& board, const host::PathScale& scale, bool relative);

/// From now on Ctrl-Z holds and resumes the feed; the other stop signals of a terminal end the path.
void catch_signals();

/// Runs it with enabled axes, from their present positions. Throws what run_path throws.
ProgramOutcome run_program(host::BoardClient& board, const host::PathBoard& machine, bool relative,
                           const RunArguments& arguments, const std::string& text);

}  // namespace axistool
