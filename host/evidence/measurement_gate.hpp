// The gate: files, data sheet and options become one checked set of measurements, or the command ends here.
#pragma once

#include <string>
#include <vector>

#include "host/record/measurements.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct GateOptions {
  std::vector<std::string> accepted;  ///< families ("sign") or kinds ("command_sign") of faults that end nothing
  /// Rows and channels stay as they were logged. Otherwise what can be mended without a guess is: a speed that only
  /// differences the position is left out, a tachometer or a current that runs late by whole samples is shifted back, a record that
  /// was homed anew is moved to the first one's zero, one that is given twice counts once. All of it is said in the
  /// log.
  bool as_logged = false;
};

class MeasurementGate {
 public:
  /// `drive` gives the data sheet and, where it has effects, what its inertia and friction are about.
  explicit MeasurementGate(const sim::DriveDescription& drive, GateOptions options = {});

  /// Reads and checks. Throws Failure(usage) for a name in `accepted` that no fault has, FaultyLog (exit code 9) where
  /// a fault makes any answer meaningless, Failure(bad_input) for a file that is no record of such a drive.
  Measurements read(const std::vector<std::string>& training, const std::vector<std::string>& validation = {}) const;

  /// The same for records that are in memory.
  Measurements admit(std::vector<Record> training, std::vector<Record> validation = {}) const;

 private:
  bool is_accepted(const LogFault& fault) const;
  /// Whether one of them is fatal and not accepted.
  bool any_stops(const std::vector<LogFault>& faults) const;
  std::vector<LogFault> check(Record& record) const;
  /// A logger that filters its current does so in all records, whether each one tells or not.
  void shift_late_currents(std::vector<Record>& training, std::vector<Record>& validation,
                           std::vector<LogFault>& faults) const;
  void share_zero(std::vector<Record>& training, std::vector<Record>& validation, std::vector<LogFault>& faults) const;
  void compare_roles(std::vector<Record>& training, std::vector<Record>& validation,
                     std::vector<LogFault>& faults) const;

  const sim::DriveDescription& drive_;
  GateOptions options_;
};

}  // namespace host
