// The default switches of a simulated axis.
#pragma once

#include "firmware/core/motion/homing.hpp"
#include "host/simulated_board/simulated_device.hpp"

namespace host {

/// A home switch at `home` mm (m) from the axis's position at power-up and, for a rotary drive, one index pulse per
/// turn.
hal::pc::AxisWiring usual_wiring(const sim::DataSheet& data, double home);

/// The drive with a home switch 25 mm (0.025 m) from its position at power-up.
SimulatedDrive usual_axis(const sim::DriveDescription& drive);

/// The homing mode of such an axis, and the home position, mm (m) from its position at power-up.
struct UsualHome {
  firmware::HomingMode mode = firmware::HomingMode::none;
  double position = 0.0;
};
UsualHome usual_home(const hal::pc::AxisWiring& wiring);

}  // namespace host
