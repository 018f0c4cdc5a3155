// The units in which a drive's quantities are shown.
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

}  // namespace host
