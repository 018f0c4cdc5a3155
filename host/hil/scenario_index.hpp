// One page with links to the pages of several scenarios.
#pragma once

#include <string>
#include <vector>

#include "host/hil/scenario_run.hpp"
#include "host/report/content.hpp"
#include "host/report/report.hpp"

namespace host {

struct IndexLine {
  std::string page;  ///< file in the folder of the index
  std::string name;
  std::string summary;
  bool holds = false, misses_aim = false;
};

IndexLine index_line(const Scenario& scenario, const ScenarioRun& run, const std::string& page);

/// "34 of 36 scenarios hold; fault-late: …, …": the total and the failures.
Verdict index_verdict(const std::vector<IndexLine>& lines);

/// The total, and one row with a link for each scenario, failures first.
Report scenario_index(const std::vector<IndexLine>& lines);

}  // namespace host
