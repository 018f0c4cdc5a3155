// Which constant speeds a set of records lacks: friction at speeds that were never held can only be guessed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/evidence/prepared_record.hpp"

namespace host {

/// Speeds of the table between which no record holds its speed, mm/s.
struct SpeedGap {
  double low_mm_s;
  double high_mm_s;
};

/// The widest gap, on a logarithmic scale, between 0.5 mm/s (the slowest Stribeck speeds) and the top speed; nothing
/// where at most a factor of three is missing.
std::optional<SpeedGap> widest_speed_gap(const std::vector<const PreparedRecord*>& records, const sim::DataSheet& data);

/// What to record so that the friction curve is seen there too, as a sentence.
std::string speeds_to_record(const SpeedGap& gap);

}  // namespace host
