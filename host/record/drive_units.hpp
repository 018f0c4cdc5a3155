// The units in which quantities of a drive are shown.
#pragma once

#include "sim/drive_description.hpp"

namespace host {

struct DriveUnits {
  const char *travel, *speed, *effort, *acceleration;
};

constexpr DriveUnits units_of(sim::DriveKind kind) {
  return kind == sim::DriveKind::rotary ? DriveUnits{"mm", "rad/s", "Nm", "rad/s²"}
                                        : DriveUnits{"m", "m/s", "N", "m/s²"};
}

/// Factor from the drive's unit of length to mm, in which travel is shown.
constexpr double travel_in_mm(sim::DriveKind kind) { return kind == sim::DriveKind::rotary ? 1.0 : 1e3; }

}  // namespace host
