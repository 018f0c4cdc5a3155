#include "host/evidence/presumed_sheet.hpp"

#include <cmath>

namespace host {

sim::DriveDescription presumed_sheet(const Record& record) {
  sim::DriveDescription sheet;
  sheet.data.kind = record.kind;
  sheet.data.sample_period_s = record.sample_period_s;
  if (record.kind == sim::DriveKind::linear || !record.has_position() || !record.has_speed()) return sheet;
  // Least squares of travel over angle. The sign is ignored, because a reversed tachometer is a separate fault.
  double travel = 0.0, angle = 0.0;
  for (std::size_t k = 1; k < record.size(); ++k) {
    const double turned = 0.5 * (record.w[k] + record.w[k - 1]) * record.sample_period_s;
    travel += turned * (record.x[k] - record.x[k - 1]);
    angle += turned * turned;
  }
  if (angle > 0.0 && travel != 0.0) sheet.data.lead = std::abs(travel) / angle;
  return sheet;
}

}  // namespace host
