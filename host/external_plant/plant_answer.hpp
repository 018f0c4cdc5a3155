// The lines between the board and a plant that is another program: `axis-plant/1`.
//
//   to the program:  axis-plant/1 AXES PERIOD_S        its answer:  ready
//                    K U|off …        (an axis each)                K X W|- …   (two fields an axis)
//
// U: the converter's voltage from now on; off: the drive is disabled. X: position at the encoder when the period ends,
// mm or m; W: what the tachometer shows, rad/s or m/s. End of input: stop.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/foreign_motion.hpp"

namespace host {

/// No machine goes farther, or faster, than this many mm (m), rad/s (m/s).
inline constexpr double kMostOfPlant = 1e9;

/// The first line, with its line feed.
std::string plant_greeting(std::size_t axes, double period_s);

/// The line of period `k`, with its line feed; an empty command: the drive is disabled.
std::string plant_line(std::uint64_t k, std::span<const std::optional<double>> commands_V);

/// What such a first line says.
struct PlantGreeting {
  std::size_t axes = 0;
  double period_s = 0.0;
};

/// Reads the first line. Throws Failure(protocol) unless it is a greeting: 1 to 64 axes, a period above 0 and up to 1
/// s.
PlantGreeting parse_plant_greeting(std::string_view line);

/// Reads the line of a period: an axis each, a voltage, or nothing where the drive is disabled. Throws
/// Failure(protocol) saying what is wrong with it and how it ought to look.
std::vector<std::optional<double>> parse_plant_line(std::string_view line, std::uint64_t k, std::size_t axes);

/// The answer of period `k`, with its line feed.
std::string plant_answer(std::uint64_t k, std::span<const sim::ForeignReading> readings);

/// Takes an answer apart. Throws Failure(protocol) saying what is wrong with it and how it ought to look.
std::vector<sim::ForeignReading> parse_plant_answer(std::string_view line, std::uint64_t k, std::size_t axes);

}  // namespace host
