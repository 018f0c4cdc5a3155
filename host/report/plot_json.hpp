// Plots as the data that report.js draws.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "host/report/content.hpp"

namespace host {

/// Traces packed (packed_samples.hpp) after decimation to at most `max_rows` rows a panel.
nlohmann::json time_plot_json(const TimePlot& plot, std::size_t max_rows);

/// Points with five significant digits, at most some thousand a series.
nlohmann::json scatter_plot_json(const ScatterPlot& plot);

/// Cells with four significant digits.
nlohmann::json heat_map_json(const HeatMap& map);

}  // namespace host
