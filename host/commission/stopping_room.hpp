// Checks with the identified drive whether an axis stops before its hard stops, with or without current.
#pragma once

#include <optional>
#include <string>

#include "host/parameters/stopping_way.hpp"

namespace host {

/// Stopping distances at the box's highest speed, mm (m), by the formulas of StoppingFigures.
struct StoppingRoom {
  double speed = 0.0;    ///< mm/s (m/s)
  double ramp = 0.0;     ///< along the reference's ramp: faults with a working sensor, Ctrl-C, a silent host
  double dropped = 0.0;  ///< without current: emergency stop, amplifier's fault. Infinite if nothing stops the axis
};
StoppingRoom stopping_room(const StoppingFigures& axis, double speed);

/// Highest speed, mm/s (m/s), from which the axis stops within `room`, mm (m), with or without current; 0 if none.
double fastest_within(const StoppingFigures& axis, double room);

/// Text for the user. `overtravel`: free travel beyond the box up to the hard stops, mm (m); empty: unknown, so nothing
/// is refused. Throws Failure(refused) if it is less than the axis needs, naming a sufficiently low speed.
std::string check_stopping_room(const StoppingFigures& axis, double speed, std::optional<double> overtravel,
                                const char* unit);

}  // namespace host
