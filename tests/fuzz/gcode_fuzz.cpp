// Any text as a program: it is refused with its line, or planned to its end within the limits.
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "host/exit_codes.hpp"
#include "host/gcode/program.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {  // NOLINT: libFuzzer's name
  if (size > 2000) return 0;
  host::GcodeMachine machine;
  machine.axes = size % 2 == 0 ? 2 : 3;
  try {
    const host::GcodeProgram program =
        host::read_gcode({reinterpret_cast<const char*>(data), size}, "fuzz.ngc", host::PathPoint::Zero(), machine);
    double length = 0.0, time_s = 0.0;
    for (const host::PathMove& move : program.moves) {
      length += move.curve.length();
      time_s += move.dwell_s + (move.feed_mm_s > 0.0 ? move.curve.length() / move.feed_mm_s : 0.0);
      if (!move.curve.end().allFinite() || !std::isfinite(move.curve.length())) std::abort();
    }
    // Plans of several minutes take too long under sanitizers and test nothing new.
    if (length > 1e4 || time_s > 60.0 || program.moves.size() > 60) return 0;
    host::PathPlanOptions options;
    options.limits = {host::PathPoint::Constant(250.0), host::PathPoint::Constant(2000.0),
                      host::PathPoint::Constant(50'000.0)};
    const host::PlannedPath path = host::plan_path(program.moves, options);
    for (std::size_t k = 0; k < path.knots.size(); ++k) {
      const host::PathKnot& knot = path.knots[k];
      if (!knot.position.allFinite() || !knot.velocity.allFinite() || !knot.acceleration.allFinite()) std::abort();
      if (k > 0 && !(knot.time_s > path.knots[k - 1].time_s)) std::abort();
    }
  } catch (const host::Failure&) {  // refused with a message
  }
  return 0;
}
