// Finds constant speeds that a set of records lacks; friction at these speeds is extrapolated.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/evidence/prepared_record.hpp"

namespace host {

/// Speeds of the table, mm/s, between which no record has a constant speed.
struct SpeedGap {
  double low_mm_s;
  double high_mm_s;
};

/// The widest gap, on a logarithmic scale, between 0.5 mm/s (the slowest Stribeck speeds) and the top speed; empty if
/// it is less than a factor of three.
std::optional<SpeedGap> widest_speed_gap(const std::vector<const PreparedRecord*>& records, const sim::DataSheet& data);

/// A sentence that says what to record to cover this gap.
std::string speeds_to_record(const SpeedGap& gap);

}  // namespace host
