// One page with two runs of a scenario: with its own controllers and with others.
#pragma once

#include <string>
#include <vector>

#include "host/hil/scenario_run.hpp"
#include "host/report/report.hpp"

namespace host {

/// A model that replaced the scenario's.
struct ReplacedModel {
  std::size_t axis = 0;
  std::string path;
};

/// "contour error 12.6 → 4.7 µm"; without a path, the larger tracking error.
std::string before_and_after(const ScenarioRun& before, const ScenarioRun& after);

Report before_after_report(const Scenario& scenario, const ScenarioRun& before, const ScenarioRun& after,
                           const std::vector<ReplacedModel>& models);

}  // namespace host
