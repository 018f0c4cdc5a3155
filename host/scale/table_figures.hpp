// Figures of the table's motion relative to the motor.
#pragma once

#include "host/report/report.hpp"
#include "host/scale/table_study.hpp"

namespace host {

/// Adds x2 - x over travel, force and time by direction, the effects found in it, and the pitch curve. Adds nothing for
/// an empty study.
void add_table_figures(const TableStudy& study, Report& report);

}  // namespace host
