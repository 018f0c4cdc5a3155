// Faults of logging that no physics explains: to be ruled out before any effect is suspected. What reading a record
// refuses anyway (dead or copied channels, gaps in time, speed against position in sign or unit) is not repeated here.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

enum class LogFaultKind {
  integer_wrap,     ///< a counter of n bits ran over
  new_zero,         ///< the position jumps by what no axis can move
  dropped_samples,  ///< the position jumps by whole samples' travel while the time stamps go on
  derived_channel,  ///< the speed is the difference of the position, not a measurement
  command_sign,     ///< the axis accelerates against its command
  command_scale,    ///< the command is not in volts, by far
  position_scale,   ///< the position is not in its unit, by far
  time_shift,       ///< a channel is logged samples early or late
};

struct LogFault {
  LogFaultKind kind;
  std::string channel;  ///< column in the file
  std::string record;   ///< path
  double t_s = 0.0;     ///< where it shows first
  double size = 0.0;    ///< of the jump, mm or m; times too large; s too late; or number of samples
  std::string message;  ///< what, where, and what mends it
};

/// "integer_wrap", as in JSON.
std::string log_fault_name(LogFaultKind kind);

/// Faults of a record that is adapted to its drive. `model` gives the data sheet and, with an inertia, what the drive
/// can do at most. Silent where physics could explain a finding: a delay, a lag, a changed inertia.
std::vector<LogFault> log_faults(const Record& record, const sim::DriveDescription& model);

nlohmann::json log_faults_json(const std::vector<LogFault>& faults);

}  // namespace host
