// Magnified deviation from a circle, as in ISO 230-4.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/hil/scenario_run.hpp"
#include "host/report/content.hpp"

namespace host {

struct CircleRun {
  std::string name;
  SeriesRole role = SeriesRole::measured;
  const ScenarioRun* run = nullptr;
};

/// The plot of the scenario's last path; empty if that is not a circle or was not followed.
std::optional<PolarPlot> circle_plot(const Scenario& scenario, const std::vector<CircleRun>& runs);

}  // namespace host
