// Records that have passed the gate. They are the input of every analysis.
#pragma once

#include <utility>
#include <vector>

#include "host/record/log_fault.hpp"
#include "host/record/record.hpp"

namespace host {

/// Records adapted to one drive, with their roles and faults. Only the gate (host/evidence/measurement_gate.hpp) makes
/// them. Pointers to the records stay valid after a move.
class Measurements {
 public:
  Measurements(Measurements&&) = default;
  Measurements& operator=(Measurements&&) = default;

  const std::vector<Record>& training() const { return training_; }
  /// If empty, a part of the training data is held back for validation.
  const std::vector<Record>& validation() const { return validation_; }
  std::vector<const Record*> training_records() const { return pointers(training_); }
  std::vector<const Record*> validation_records() const { return pointers(validation_); }
  /// The training records, then the validation records.
  std::vector<const Record*> all_records() const {
    std::vector<const Record*> all = training_records();
    for (const Record& record : validation_) all.push_back(&record);
    return all;
  }

  /// Faults that are not fatal, and fatal faults that the user accepted.
  const std::vector<LogFault>& log() const { return log_; }

 private:
  friend class MeasurementGate;
  Measurements(std::vector<Record> training, std::vector<Record> validation, std::vector<LogFault> log)
      : training_(std::move(training)), validation_(std::move(validation)), log_(std::move(log)) {}

  static std::vector<const Record*> pointers(const std::vector<Record>& records) {
    std::vector<const Record*> result;
    for (const Record& record : records) result.push_back(&record);
    return result;
  }

  std::vector<Record> training_, validation_;
  std::vector<LogFault> log_;
};

}  // namespace host
