#include "host/response/compliance.hpp"

#include <cmath>

namespace host {

Compliance largest_compliance(const FinePlant& drive, const AxisController& controller, const RigidAxis& axis,
                              sim::DriveKind kind) {
  const double um = kind == sim::DriveKind::linear ? 1e6 : 1e3;  // in the unit of the position
  const double um_per_N = um / newton_per_volt(axis, kind);
  Compliance found;
  for (std::size_t i = 0; i < drive.f_Hz.size(); ++i) {
    const std::complex<double> L = (controller.at(drive.f_Hz[i]) * drive.plant[i])(0);
    const double here = um_per_N * std::abs(drive.plant[i](0) / (1.0 + L));
    if (here > found.um_per_N) found = {here, drive.f_Hz[i]};
  }
  return found;
}

}  // namespace host
