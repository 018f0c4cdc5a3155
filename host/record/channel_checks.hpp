// Checks the channels of a record against each other, to rule out faults of logging before any physics.
#pragma once

#include <string_view>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Largest command that a D/A converter or amplifier takes, V. Larger numbers are counts or mV.
inline constexpr double kLargestCommand_V = 1000.0;
/// Largest motor current of a feed drive, A. Larger numbers are mA.
inline constexpr double kLargestCurrent_A = 10000.0;
/// Farthest position, mm or m, and fastest speed, rad/s or m/s: a thousand kilometres, and a hundred times the fastest
/// spindle. With larger values, sums of squares lose precision.
inline constexpr double kFarthest = 1e9;
inline constexpr double kFastest = 1e6;
/// Absolute zero, and a temperature that no part of a feed drive survives, deg C. Kelvins read as Celsius are above it.
inline constexpr double kLowestTemperature_C = -273.15;
inline constexpr double kHighestTemperature_C = 200.0;

/// Checks that need only the record: dead channels (constant, although another channel shows motion), values that no
/// unit explains and, on linear drives, speed against position. A standstill passes, and so does an axis that never
/// breaks away. Throws Failure(bad_input).
void check_channels(const Record& record);

/// Scales travel and speed to the units of the drive (rotary: mm, rad/s; linear: m, m/s). Throws Failure(bad_input) if
/// the record has a speed or a command that a drive of that kind does not have.
void adapt_to(Record& record, const sim::DataSheet& sheet);

/// Checks a record that is adapted to its drive: speed against position by the lead, position against the encoder's
/// resolution, command against the range of the D/A converter. Throws Failure(bad_input) with the column and the unit
/// that would fit.
void check_units(const Record& record, const sim::DataSheet& sheet);

/// Rejects a record that was sampled more slowly than `lowest_Hz`. `purpose` completes "too slow to …".
void require_rate(const Record& record, double lowest_Hz, std::string_view purpose);

/// Rejects a record that is shorter than `shortest_s`. `purpose` completes "too short to …".
void require_duration(const Record& record, double shortest_s, std::string_view purpose);

}  // namespace host
