// The public EMPS benchmark: a real linear drive. Its records are not part of the project.
#pragma once

#include <string>

#include "host/demo/demo_figure.hpp"
#include "host/report/report.hpp"

namespace host {

/// `folder` contains DATA_EMPS.mat and DATA_EMPS_PULSES.mat of "Data set and reference models of EMPS" (Janot, Gautier,
/// Brunot 2019). Imports both, identifies from the first and checks on the second. Throws Failure(bad_input) if a file
/// is missing.
DemoPart show_emps(const std::string& folder, Report& report);

}  // namespace host
