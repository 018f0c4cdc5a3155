// Finds constant speeds that are missing in a set of records, at which the friction is only extrapolated.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/evidence/prepared_record.hpp"

namespace host {

/// Two speeds of the table, mm/s. No record has a constant speed between them.
struct SpeedGap {
  double low_mm_s;
  double high_mm_s;
};

/// The gap with the largest ratio between 0.5 mm/s (the slowest Stribeck speeds) and the top speed; empty if the ratio
/// is less than three.
std::optional<SpeedGap> widest_speed_gap(const std::vector<const PreparedRecord*>& records, const sim::DataSheet& data);

/// A sentence that says which motion to record to close this gap.
std::string speeds_to_record(const SpeedGap& gap);

}  // namespace host
