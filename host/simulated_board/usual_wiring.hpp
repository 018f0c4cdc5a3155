// The switches of a simulated axis, where nobody says otherwise.
#pragma once

#include "firmware/core/motion/homing.hpp"
#include "host/simulated_board/simulated_device.hpp"

namespace host {

/// A home switch at `home` mm (m) from where the axis is at power-up and, on a shaft, an index pulse each turn.
hal::pc::AxisWiring usual_wiring(const sim::DataSheet& data, double home);

/// The drive with a home switch 25 mm (0.025 m) from where it is at power-up.
SimulatedDrive usual_axis(const sim::DriveDescription& drive);

/// What finds home on such an axis, and the place that is found, mm (m) from where the axis is at power-up.
struct UsualHome {
  firmware::HomingMode mode = firmware::HomingMode::none;
  double position = 0.0;
};
UsualHome usual_home(const hal::pc::AxisWiring& wiring);

}  // namespace host
