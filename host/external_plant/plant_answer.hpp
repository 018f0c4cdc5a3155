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

/// Takes an answer apart. Throws Failure(protocol) saying what is wrong with it and how it ought to look.
std::vector<sim::ForeignReading> parse_plant_answer(std::string_view line, std::uint64_t k, std::size_t axes);

}  // namespace host
