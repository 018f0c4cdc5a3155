// Reads and checks files, data sheet and options, and returns one set of measurements; or ends the command.
#pragma once

#include <string>
#include <vector>

#include "host/record/measurements.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct GateOptions {
  std::vector<std::string>
      accepted;  ///< families ("sign") or kinds ("command_sign") of faults despite which the command continues
  /// Keeps rows and channels as they were logged. Otherwise every fault with a unique correction is corrected: a speed
  /// that is only the difference of positions is left out; a tachometer or current that is late by whole samples is
  /// shifted back; a record that was homed again is moved to the zero of the first record; a record that is given twice
  /// counts once. The log states each correction.
  bool as_logged = false;
};

class MeasurementGate {
 public:
  /// `drive` gives the data sheet and, if it has effects, approximate inertia and friction.
  explicit MeasurementGate(const sim::DriveDescription& drive, GateOptions options = {});

  /// Reads and checks the files. Throws Failure(usage) for a name in `accepted` that no fault has, FaultyLog (exit code
  /// 9) if a fault makes any answer meaningless, Failure(bad_input) for a file that is not a record of such a drive.
  Measurements read(const std::vector<std::string>& training, const std::vector<std::string>& validation = {}) const;

  /// The same for records that are in memory.
  Measurements admit(std::vector<Record> training, std::vector<Record> validation = {}) const;

 private:
  bool is_accepted(const LogFault& fault) const;
  /// Whether one of the faults is fatal and not accepted.
  bool any_stops(const std::vector<LogFault>& faults) const;
  std::vector<LogFault> check(Record& record) const;
  /// A logger that filters its current does so in all records, even if one of them does not show it.
  void shift_late_currents(std::vector<Record>& training, std::vector<Record>& validation,
                           std::vector<LogFault>& faults) const;
  void share_zero(std::vector<Record>& training, std::vector<Record>& validation, std::vector<LogFault>& faults) const;
  void compare_roles(std::vector<Record>& training, std::vector<Record>& validation,
                     std::vector<LogFault>& faults) const;

  const sim::DriveDescription& drive_;
  GateOptions options_;
};

}  // namespace host
