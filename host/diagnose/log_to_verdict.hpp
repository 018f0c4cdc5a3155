// Identifies and diagnoses an unknown machine from records and a motor constant.
#pragma once

#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/identify/identification.hpp"

namespace host {

/// The data sheet for one or more logs of the current if only the motor constant is known (Nm/A; N/A for a linear
/// drive). It has no converter, and the encoder's step as the positions show it; if `lead_mm_per_rad` is 0, 1 mm stands
/// for 1 rad.
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
