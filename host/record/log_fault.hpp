// Faults of a log that no physics explains, and the failure of a command because of such a fault.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/exit_codes.hpp"

namespace host {

enum class LogFaultKind {
  integer_wrap,      ///< an n-bit counter overflowed, or an angle wrapped after a turn
  new_zero,          ///< the position jumps farther than an axis can move
  dropped_samples,   ///< samples are missing, as time stamps or a jump by whole samples show
  uneven_clock,      ///< samples are late despite even time stamps, and the next one catches up
  derived_channel,   ///< the speed is the difference of the position, not a measurement
  command_sign,      ///< the axis accelerates against its command
  command_scale,     ///< the command is clearly not in volts
  position_scale,    ///< the position is clearly not in its unit
  time_shift,        ///< a channel is logged early or late by whole samples
  speed_sign,        ///< the speed has the opposite sign of the position's change
  table_sign,        ///< the table's position has the opposite direction of the motor's
  wrong_unit,        ///< values that are impossible in their unit
  dead_channel,      ///< constant although another channel shows motion
  copied_channel,    ///< one channel logged twice
  swapped,           ///< the columns of position and speed are exchanged
  clipped,           ///< the log clips the command, but the amplifier did not
  scaled_copy,       ///< one channel is another times a constant
  another_zero,      ///< homed again: periodic effects are shifted relative to the first record
  same_record,       ///< validation rows that are also training rows, or rows given twice
  records_disagree,  ///< the records are from different machines, or a scale changed between them
  other_drive,       ///< its header names another drive than the model
  no_encoder,        ///< positions are multiples of a step, but the data sheet has no encoder
};

/// The name of the kind, "integer_wrap", and the name of its family for programs and `--accept`, "jump".
std::string_view log_fault_name(LogFaultKind kind);
std::string_view log_fault_family(LogFaultKind kind);

/// Remedy for a fault of this kind, as a clause.
std::string_view log_fault_remedy(LogFaultKind kind);

struct LogFault {
  LogFaultKind kind;
  std::string channel;  ///< column in the file
  std::string record;   ///< path
  double t_s = 0.0;     ///< time at which it shows first
  /// Depends on the kind: size of the jump or distance of the zeros, mm or m; factor by which values are too large;
  /// delay, s; number of samples; common duration, s.
  double size = 0.0;
  std::string message;    ///< the fault, its place, and its remedy
  bool fatal = true;      ///< true if any answer from the record would be meaningless
  bool accepted = false;  ///< true if fatal but accepted by the user
};

/// A log that allows no analysis: exit code 9.
class FaultyLog : public Failure {
 public:
  FaultyLog(const std::string& message, std::vector<LogFault> found)
      : Failure(ExitCode::bad_input, message), faults(std::move(found)) {}
  std::vector<LogFault> faults;
};

}  // namespace host
