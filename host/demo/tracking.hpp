// Third part of the demonstration: step and jog in closed loop with gains designed from the identified model.
#pragma once

#include "host/demo/demo_figure.hpp"
#include "host/report/report.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// `machine` is the plant; the controller uses only `identified`.
DemoPart show_tracking(const sim::DriveDescription& machine, const sim::DriveDescription& identified, Report& report);

}  // namespace host
