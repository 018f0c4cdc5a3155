// G-code (RS274/NGC, NIST IR 6556, LinuxCNC's dialect) for a machine with two or three axes and no spindle.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/path/path_plan.hpp"

namespace host {

/// Properties of the machine on which a program runs.
struct GcodeMachine {
  std::size_t axes = 2;                ///< X, Y and, with 3, Z
  PathPoint home = PathPoint::Zero();  ///< target of G28, mm
  bool begins_anywhere = false;        ///< the start position is unknown: arcs are not checked until a line has set it
  double feed_share = 1.0;             ///< override of the feeds F, > 0; the limits of the axes still hold
  double rapid_share = 1.0;            ///< override of rapids, 0 to 1, relative to `fastest_mm_s`
  PathPoint fastest_mm_s = PathPoint::Constant(1e9);  ///< of each axis, > 0
  std::vector<PathPoint> probed;  ///< ends of the first probing moves; assumes that the others reach their targets
};

/// A probing move: G38.2 to G38.5.
struct GcodeProbe {
  std::size_t move = 0;       ///< index in the program's moves
  bool is_away = false;       ///< seeks the loss of contact: G38.4, G38.5
  bool must_succeed = false;  ///< otherwise the program is in error: G38.2, G38.4
  int tenths() const { return is_away ? (must_succeed ? 4 : 5) : (must_succeed ? 2 : 3); }
};

struct GcodeProgram {
  std::vector<PathMove> moves;
  std::vector<GcodeProbe> probes;
  std::vector<std::size_t> rapid_lines;  ///< ascending; a line contains either rapids or feeds
  std::size_t lines = 0;                 ///< number of lines of the text
  bool is_absolute = false;              ///< it contains an absolute position
};

/// G0 G1 G2 G3 (centre by I J, or R; X Y Z) G4 P G17 G20 G21 G28 G38.2 to G38.5 G54 G61 G64 [P] G90 G91 F M0 M1 M2 M30
/// N, comments in parentheses or behind a semicolon, `%` around it, block delete `/`. Begins with G17 G21 G54 G61 G90
/// and no feed. M0 and M1 stop the program until the operator continues it. G64 without P keeps within 0.05 mm. Throws
/// Failure(bad_input) "NAME:LINE: what" for anything else.
GcodeProgram read_gcode(std::string_view text, const std::string& name, const PathPoint& start,
                        const GcodeMachine& machine);

}  // namespace host
