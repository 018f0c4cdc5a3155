// Whether an axis comes to rest before its hard stops, with or without current, by the identified drive.
#pragma once

#include <optional>
#include <string>

#include "host/parameters/stopping_way.hpp"

namespace host {

/// Stopping distances at the box's highest speed, mm (m), by the formulas of StoppingFigures.
struct StoppingRoom {
  double speed = 0.0;    ///< mm/s (m/s)
  double ramp = 0.0;     ///< along the reference's ramp: faults that leave a working sensor, Ctrl-C, a silent host
  double dropped = 0.0;  ///< without current: emergency stop, amplifier's fault. Infinite where nothing stops it
};
StoppingRoom stopping_room(const StoppingFigures& axis, double speed);

/// Highest speed, mm/s (m/s), from which the axis stops within `room`, mm (m), with or without current; 0 if none.
double fastest_within(const StoppingFigures& axis, double room);

/// For the user. `overtravel`: free beyond the box up to the hard stops, mm (m); empty: unknown, so nothing is refused.
/// Throws Failure(refused) where it is less than the axis needs, saying from what speed it would do.
std::string check_stopping_room(const StoppingFigures& axis, double speed, std::optional<double> overtravel,
                                const char* unit);

}  // namespace host
