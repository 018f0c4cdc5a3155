// Second part of the demonstration: an axis of the paper on the simulated plant, from steps to designed gains.
#pragma once

#include <string_view>

#include "host/demo/demo_figure.hpp"
#include "host/report/report.hpp"
#include "sim/drive_description.hpp"

namespace host {

struct PaperAxisOutcome {
  DemoPart part;
  sim::DriveDescription identified;  ///< identified inertia and friction curve, for the design of the controller
};

/// Axis "x" or "y" of Table 1. Open-loop steps at Ku = 15 by all methods of least squares, jogs at the paper's eleven
/// speeds in closed loop, friction curve.
PaperAxisOutcome show_paper_axis(std::string_view axis, Report& report);

}  // namespace host
