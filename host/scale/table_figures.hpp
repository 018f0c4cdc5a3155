// What the table does against the motor, as figures of a page.
#pragma once

#include "host/report/report.hpp"
#include "host/scale/table_study.hpp"

namespace host {

/// x2 - x over travel, force and time by direction, what was found in it, and the pitch curve. Nothing of an empty
/// study.
void add_table_figures(const TableStudy& study, Report& report);

}  // namespace host
