#include "host/response/compliance.hpp"

#include <cmath>

namespace host {

Compliance largest_compliance(const FinePlant& drive, const AxisController& controller, const RigidAxis& axis,
                              sim::DriveKind kind) {
  // Rotary: mm/V over Nm/V, and N = Nm / (mm/rad) * 1e3. Linear: m/V over N/V.
  const double um_per_N = (kind == sim::DriveKind::linear ? 1e6 : axis.lead) / axis.effort_per_volt;
  Compliance found;
  for (std::size_t i = 0; i < drive.f_Hz.size(); ++i) {
    const std::complex<double> L = (controller.at(drive.f_Hz[i]) * drive.plant[i])(0);
    const double here = um_per_N * std::abs(drive.plant[i](0) / (1.0 + L));
    if (here > found.um_per_N) found = {here, drive.f_Hz[i]};
  }
  return found;
}

}  // namespace host
