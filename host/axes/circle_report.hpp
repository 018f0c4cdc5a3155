// A circle's diagnosis as an HTML page and as text for a terminal.
#pragma once

#include <string>

#include "host/axes/circle_diagnosis.hpp"
#include "host/report/report.hpp"
#include "host/report/terminal.hpp"

namespace host {

/// The circle magnified in both directions, each cause with its own figure and share, the terms of ISO 230-4, and
/// causes that these sensors do not show.
Report circle_report(const CircleDiagnosis& diagnosis, const std::string& subtitle);

std::string circle_text(const CircleDiagnosis& diagnosis, const Terminal& terminal);

}  // namespace host
