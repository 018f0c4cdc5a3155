// Faults of a log that no physics explains, and the failure of a command that meets one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/exit_codes.hpp"

namespace host {

enum class LogFaultKind {
  integer_wrap,      ///< a counter of n bits ran over, or an angle began again after its turn
  new_zero,          ///< the position jumps farther than an axis can move
  dropped_samples,   ///< samples are missing, by their time stamps or by a jump of whole samples' travel
  uneven_clock,      ///< samples come late under steady time stamps, and the next one catches up
  derived_channel,   ///< the speed is the difference of the position, not a measurement
  command_sign,      ///< the axis accelerates against its command
  command_scale,     ///< the command is not in volts, by far
  position_scale,    ///< the position is not in its unit, by far
  time_shift,        ///< a channel is logged samples early or late
  speed_sign,        ///< the speed runs against the position
  table_sign,        ///< the table's position runs against the motor's
  wrong_unit,        ///< values that are impossible in their unit
  dead_channel,      ///< constant where another channel shows motion
  copied_channel,    ///< one channel logged twice
  swapped,           ///< position and speed stand in each other's column
  clipped,           ///< the log cuts the command off where the amplifier did not
  scaled_copy,       ///< one channel is another times a constant
  another_zero,      ///< periodic effects along the travel are shifted against the first record: homed again
  same_record,       ///< validation rows that are also training rows, or rows given twice
  records_disagree,  ///< the records are not of one machine, or a channel's scale changed between them
  other_drive,       ///< its header names another drive than the model
  no_encoder,        ///< positions lie on a grid, but the data sheet has no encoder
};

/// The kind's own name, "integer_wrap", and the name of the family that programs and `--accept` know, "jump".
std::string_view log_fault_name(LogFaultKind kind);
std::string_view log_fault_family(LogFaultKind kind);

/// Remedy for a fault of this kind, as a clause.
std::string_view log_fault_remedy(LogFaultKind kind);

struct LogFault {
  LogFaultKind kind;
  std::string channel;  ///< column in the file
  std::string record;   ///< path
  double t_s = 0.0;     ///< where it shows first
  /// By kind: size of the jump or distance of the zeros, mm or m; factor by which values are too large; delay, s;
  /// number of samples; common duration, s.
  double size = 0.0;
  std::string message;    ///< the fault, its place, and its remedy
  bool fatal = true;      ///< any answer from such a record would be meaningless
  bool accepted = false;  ///< fatal, but the user continues anyway
};

/// A log that allows no analysis: exit code 9.
class FaultyLog : public Failure {
 public:
  FaultyLog(const std::string& message, std::vector<LogFault> found)
      : Failure(ExitCode::bad_input, message), faults(std::move(found)) {}
  std::vector<LogFault> faults;
};

}  // namespace host
