// The part of a comparison that its reader selects.
#pragma once

#include <optional>
#include <string>

#include "host/report/content.hpp"

namespace host {

/// It selects what is plotted and changes no figure.
struct Focus {
  std::string record = {};               ///< whose traces are drawn; empty: the one with the largest error
  std::optional<TimeSpan> stretch = {};  ///< of that record, lit in every plot
  std::optional<double> period_mm = {};  ///< of the travel, within which the residual is drawn; else the model's ripple
};

}  // namespace host
