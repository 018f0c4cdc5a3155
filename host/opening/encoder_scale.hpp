// Usual scales of encoders, screws and loggers, to confirm a measured factor.
#pragma once

#include <optional>
#include <string>

namespace host {

struct NeatScale {
  double value = 0.0;
  std::string words;
};

/// The counts a millimetre of a usual encoder (lines a turn times four, 2^n) on a usual screw within `tolerance` of
/// what was measured; empty where there is none.
std::optional<NeatScale> neat_counts_per_mm(double measured, double tolerance);

/// The same for counts a radian: a usual encoder alone.
std::optional<NeatScale> neat_counts_per_rad(double measured, double tolerance);

/// A factor to rad/s within 2 % of what a usual unit of speed has ("1/min", 0.10472).
std::optional<NeatScale> neat_angular_speed(double measured);

/// The same to mm/s.
std::optional<NeatScale> neat_linear_speed(double measured);

/// A factor to rad (turns, degrees).
std::optional<NeatScale> neat_angle(double measured);

/// A factor to mm (m, inch, um).
std::optional<NeatScale> neat_length(double measured);

}  // namespace host
