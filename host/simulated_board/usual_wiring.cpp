#include "host/simulated_board/usual_wiring.hpp"

#include <cmath>

namespace host {

hal::pc::AxisWiring usual_wiring(const sim::DataSheet& data, double home) {
  hal::pc::AxisWiring wiring;
  wiring.home = home;
  wiring.index_spacing = data.turn();
  wiring.index_offset = 1.0;
  return wiring;
}

SimulatedDrive usual_axis(const sim::DriveDescription& drive) {
  return {drive, usual_wiring(drive.data, drive.data.kind == sim::DriveKind::rotary ? 25.0 : 0.025)};
}

UsualHome usual_home(const hal::pc::AxisWiring& wiring) {
  if (wiring.index_spacing == 0.0) return {firmware::HomingMode::home_switch, wiring.home};
  const double turns = std::ceil((wiring.home - wiring.index_offset) / wiring.index_spacing);
  return {firmware::HomingMode::switch_and_index, wiring.index_offset + turns * wiring.index_spacing};
}

}  // namespace host
