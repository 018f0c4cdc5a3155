// Identifies and diagnoses an unknown machine from records and a motor constant.
#pragma once

#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/identify/identification.hpp"

namespace host {

/// The data sheet of logs of the current (one or more) of which the motor's constant alone is known (Nm/A; N/A where
/// the records are of a linear drive): a millimetre for a radian where `lead_mm_per_rad` is 0, no converter, the
/// encoder's step as the positions show it.
sim::DriveDescription sheet_of_constant(const std::vector<Record>& records, double motor_constant,
                                        double lead_mm_per_rad);

struct LogVerdict {
  Measurements measured;
  Identification identification;
  Diagnosis diagnosis;  ///< refers to `measured`
};

/// Records named "valid", "test" or "check" are for validation; without one, blocks of the others are held back. Throws
/// as the gate, identify_drive() and diagnose() do.
std::unique_ptr<LogVerdict> verdict_of(std::vector<Record> records, const sim::DriveDescription& sheet,
                                       const std::vector<std::string>& accepted, const ShareDone& progress = {});

}  // namespace host
