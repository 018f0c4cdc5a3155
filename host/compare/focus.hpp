// The part of a comparison that the user selects.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "host/report/content.hpp"

namespace host {

/// Selects what is plotted; the error figures do not change.
struct Focus {
  std::string record = {};               ///< record whose traces are drawn; if empty, the one with the largest error
  std::optional<TimeSpan> stretch = {};  ///< interval of that record that every plot highlights
  /// Coordinates of the map of the residual, by their names in the catalogue; default: position and speed.
  std::optional<std::pair<std::string, std::string>> map = {};
  /// A plot of the second over the first: names as kPlotCoordinates, and "error" for the missing torque or force.
  std::optional<std::pair<std::string, std::string>> plot = {};
  std::optional<double> period_mm = {};  ///< period of the plots; default: that of the model's ripple
};

/// Coordinates that a map may have.
inline constexpr std::array kMapCoordinates{
    "position", "speed", "acceleration", "current", "time", "travel_since_reversal", "rest"};

/// Coordinates of a chosen plot: those of a map, and more. "phase": position within the period.
inline constexpr std::array kPlotCoordinates{
    "position", "phase", "speed", "acceleration", "current", "time", "travel_since_reversal", "rest", "temperature"};
inline constexpr const char* kPlottedError = "error";

}  // namespace host
