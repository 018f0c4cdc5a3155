// Requests of the page to a board, as JSON.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace host::workbench {

/// All functions throw Failure(usage) naming the field and its expected value.

/// { "owner": KEY }.
std::string parse_owner(std::string_view text);

/// { "owner": KEY, "do": "jog", "axis": "x", "velocity": 20 }; mm/s (m/s). move has "position" instead, mm (m). halt
/// and clear_faults concern all axes.
struct MotionRequest {
  enum class Action { enable, disable, jog, move, halt, home, home_here, clear_faults };
  std::string owner, axis;
  Action action = Action::halt;
  double velocity = 0.0, position = 0.0;
};
MotionRequest parse_motion(std::string_view text);

/// { "channels": ["x.u_V", …] }.
std::vector<std::string> parse_channels(std::string_view text);

/// { "axis": "x", "trigger": "x.position_error > 20um", "before_s": 0.1, "after_s": 0.4 }.
struct TriggerWish {
  std::string axis, trigger;
  double before_s = 0.0, after_s = 0.0;
};
TriggerWish parse_trigger_wish(std::string_view text);

/// { "epoch": 1, "from": 0, "to": 1000 }: rows of a stream.
struct RowsRequest {
  std::uint64_t epoch = 0, from = 0, to = 0;
};
RowsRequest parse_rows(std::string_view text);

/// { "owner": KEY, "values": { "x.feedback.k1": "48.4" } }: the assignments as on the command line.
struct ParametersRequest {
  std::string owner;
  std::vector<std::string> assignments;
};
ParametersRequest parse_parameters(std::string_view text);

/// { "text": TOML, "name": of the file, "axis": "x" or "" }: a file of parameters that the page has read.
struct ParameterText {
  std::string text, name, axis;
};
ParameterText parse_parameter_file(std::string_view text);

}  // namespace host::workbench
