// Plots as data for report.js.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "host/report/content.hpp"

namespace host {

/// Packed traces (packed_samples.hpp), decimated to at most `max_rows` rows per panel.
nlohmann::json time_plot_json(const TimePlot& plot, std::size_t max_rows);

/// Points with five significant digits, at most some thousand per series.
nlohmann::json scatter_plot_json(const ScatterPlot& plot);

/// Cells with four significant digits.
nlohmann::json heat_map_json(const HeatMap& map);

}  // namespace host
