// Results of a scenario's run: report, JSON, text for the terminal.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "host/hil/scenario_run.hpp"
#include "host/report/report.hpp"
#include "host/report/terminal.hpp"

namespace host {

/// Good, target missed, or requirement failed.
struct ScenarioOutcome {
  Tone tone = Tone::neutral;
  std::string word;
};
ScenarioOutcome outcome_of(const ScenarioRun& run);

/// "Contour error up to 12.6 µm; 3 of 4 expectations hold".
std::string summary_of(const ScenarioRun& run);

Report scenario_report(const Scenario& scenario, const ScenarioRun& run);
/// "axis-hil/1".
nlohmann::json scenario_json(const Scenario& scenario, const ScenarioRun& run);
std::string scenario_text(const Scenario& scenario, const ScenarioRun& run, const Terminal& terminal);

}  // namespace host
