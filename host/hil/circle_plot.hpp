// What became of a circle, as machinists look at it: the deviation about the circle, magnified.
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

/// Of the scenario's last path; nothing where that is no circle, or was not followed.
std::optional<PolarPlot> circle_plot(const Scenario& scenario, const std::vector<CircleRun>& runs);

}  // namespace host
