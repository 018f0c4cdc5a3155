// Identifies and diagnoses an unknown machine from records and a motor constant.
#pragma once

#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/identify/identification.hpp"

namespace host {

/// The data sheet for logs of the current, if only the motor constant is known (Nm/A; N/A for a linear drive). It has
/// no converter. The encoder's step comes from the positions. If `lead_mm_per_rad` is 0, 1 mm stands for 1 rad.
sim::DriveDescription sheet_of_constant(const std::vector<Record>& records, double motor_constant,
                                        double lead_mm_per_rad);

struct LogVerdict {
  Measurements measured;
  Identification identification;
  Diagnosis diagnosis;  ///< refers to `measured`
};

/// Records named "valid", "test" or "check" are for validation. If there is none, blocks of the other records are held
/// back. Throws as the gate, identify_drive() and diagnose() do.
std::unique_ptr<LogVerdict> verdict_of(std::vector<Record> records, const sim::DriveDescription& sheet,
                                       const std::vector<std::string>& accepted, const ShareDone& progress = {});

}  // namespace host
