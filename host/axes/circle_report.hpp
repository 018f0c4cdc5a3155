// A circle's diagnosis as an HTML page and as text for a terminal.
#pragma once

#include <string>

#include "host/axes/circle_diagnosis.hpp"
#include "host/report/report.hpp"
#include "host/report/terminal.hpp"

namespace host {

/// The magnified circle in both directions, each cause with its plot and share, the terms of ISO 230-4, and the causes
/// that these sensors cannot show.
Report circle_report(const CircleDiagnosis& diagnosis, const std::string& subtitle);

std::string circle_text(const CircleDiagnosis& diagnosis, const Terminal& terminal);

}  // namespace host
