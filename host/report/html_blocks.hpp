// The parts of a report that need no script: verdict, bars, tables, facts.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "host/report/content.hpp"

namespace host::html {

std::string verdict(const Verdict& verdict);
std::string bar_chart(const BarChart& chart);
std::string table(const Table& table);
std::string facts(const Facts& facts);

enum class FrameWidth { full, half };

/// The frame into which report.js draws plot number `index`. Two frames of half width are side by side if there is
/// room.
std::string plot_frame(std::size_t index, FrameWidth width, std::string_view title, std::string_view caption,
                       std::string_view hint);

}  // namespace host::html
