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

/// Throws Failure(refused) if the weight exceeds the friction, unless the board notices a dead encoder at rest: by a
/// tachometer or the fault output of the encoder's receivers. With a dead encoder the command stays as it is, and any
/// change of the load accelerates the axis unnoticed.
void check_feedback_at_rest(const StoppingFigures& axis, bool notices_dead_encoder);

}  // namespace host
