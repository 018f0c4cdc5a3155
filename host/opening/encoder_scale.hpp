// Usual scales of encoders, screws and loggers, which confirm a measured factor.
#pragma once

#include <optional>
#include <string>

namespace host {

struct NeatScale {
  double value = 0.0;
  std::string words;
};

/// Counts per millimetre of a usual encoder (lines per turn times four, or 2^n) on a usual screw, within `tolerance` of
/// the measured value. Empty if there is none.
std::optional<NeatScale> neat_counts_per_mm(double measured, double tolerance);

/// The same for counts per radian of a usual encoder.
std::optional<NeatScale> neat_counts_per_rad(double measured, double tolerance);

/// The usual unit of speed whose factor to rad/s is within 2 % of the measured one ("1/min", 0.10472).
std::optional<NeatScale> neat_angular_speed(double measured);

/// The same to mm/s.
std::optional<NeatScale> neat_linear_speed(double measured);

/// A usual unit of angle (turns, degrees), as a factor to rad.
std::optional<NeatScale> neat_angle(double measured);

/// A usual unit of length (m, inch, um), as a factor to mm.
std::optional<NeatScale> neat_length(double measured);

}  // namespace host
