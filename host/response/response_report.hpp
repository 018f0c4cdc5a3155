// A frequency response as an HTML page and as text for a terminal.
#pragma once

#include <string>

#include "host/report/report.hpp"
#include "host/report/terminal.hpp"
#include "host/response/axis_response.hpp"

namespace host {

/// Verdict, margins, Bode plots with intervals, Nyquist plot with the circle of the modulus margin, resonances.
/// `before`: another state of the axis drawn beside it; nullptr: none.
Report response_report(const AxisResponse& axis, const std::string& subtitle, const AxisResponse* before = nullptr);

/// The margins of both, in columns.
std::string margins_text(const AxisResponse& axis, const AxisResponse* before, const Terminal& terminal);

std::string response_text(const AxisResponse& axis, const Terminal& terminal);

}  // namespace host
