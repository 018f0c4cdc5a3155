// One page with links to the pages of several scenarios.
#pragma once

#include <string>
#include <vector>

#include "host/hil/scenario_run.hpp"
#include "host/report/content.hpp"
#include "host/report/report.hpp"

namespace host {

struct IndexLine {
  std::string page;  ///< file beside the index
  std::string name;
  std::string summary;
  bool holds = false, misses_aim = false;
};

IndexLine index_line(const Scenario& scenario, const ScenarioRun& run, const std::string& page);

/// "34 of 36 scenarios hold; fault-late: …, …": the total, and what failed.
Verdict index_verdict(const std::vector<IndexLine>& lines);

/// One row with a link for each, failures first; the total above.
Report scenario_index(const std::vector<IndexLine>& lines);

}  // namespace host
