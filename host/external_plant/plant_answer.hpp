// The lines between the board and an external plant program: `axis-plant/1`.
//
//   to the program:  axis-plant/1 AXES PERIOD_S        its answer:  ready
//                    K U|off …        (an axis each)                K X W|- …   (two fields an axis)
// U: voltage of the converter from now on; off: the drive is disabled. X: encoder position at the end of the period, mm
// or m; W: tachometer reading, rad/s or m/s. The program stops at the end of its input.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/foreign_motion.hpp"

namespace host {

/// Upper bound of position and speed, mm (m), rad/s (m/s); larger than in any machine.
inline constexpr double kMostOfPlant = 1e9;

/// The first line, with its line feed.
std::string plant_greeting(std::size_t axes, double period_s);

/// The line of period `k`, with its line feed. An empty command means that the drive is disabled.
std::string plant_line(std::uint64_t k, std::span<const std::optional<double>> commands_V);

/// Content of such a first line.
struct PlantGreeting {
  std::size_t axes = 0;
  double period_s = 0.0;
};

/// Reads the first line. Throws Failure(protocol) unless it is a greeting: 1 to 64 axes, a period above 0 and up to 1
/// s.
PlantGreeting parse_plant_greeting(std::string_view line);

/// Reads the line of a period: for each axis a voltage, or nothing if the drive is disabled. Throws Failure(protocol)
/// with the fault and the expected form.
std::vector<std::optional<double>> parse_plant_line(std::string_view line, std::uint64_t k, std::size_t axes);

/// The answer of period `k`, with its line feed.
std::string plant_answer(std::uint64_t k, std::span<const sim::ForeignReading> readings);

/// Parses an answer. Throws Failure(protocol) with the fault and the expected form.
std::vector<sim::ForeignReading> parse_plant_answer(std::string_view line, std::uint64_t k, std::size_t axes);

}  // namespace host
