// A frequency response as an HTML page and as text for a terminal.
#pragma once

#include <string>

#include "host/report/report.hpp"
#include "host/report/terminal.hpp"
#include "host/response/axis_response.hpp"

namespace host {

/// Verdict, margins, Bode plots with intervals, Nyquist plot with the circle of the modulus margin, resonances.
/// `before`: an earlier state of the axis to draw for comparison; may be nullptr.
Report response_report(const AxisResponse& axis, const std::string& subtitle, const AxisResponse* before = nullptr);

/// Table of the margins of `axis` and, if given, `before`.
std::string margins_text(const AxisResponse& axis, const AxisResponse* before, const Terminal& terminal);

std::string response_text(const AxisResponse& axis, const Terminal& terminal);

}  // namespace host
