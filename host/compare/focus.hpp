// The part of a comparison that the user selects.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "host/report/content.hpp"

namespace host {

/// Selects what is plotted; all figures stay the same.
struct Focus {
  std::string record = {};               ///< whose traces are drawn; empty: the one with the largest error
  std::optional<TimeSpan> stretch = {};  ///< of that record, highlighted in every plot
  /// Coordinates of the map of the residual, by their names in the catalogue; else position and speed.
  std::optional<std::pair<std::string, std::string>> map = {};
  std::optional<double> period_mm = {};  ///< over which the residual is drawn; default: that of the model's ripple
};

/// Coordinates that a map may have.
inline constexpr std::array kMapCoordinates{
    "position", "speed", "acceleration", "current", "time", "travel_since_reversal", "rest"};

}  // namespace host
