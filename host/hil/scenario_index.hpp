// The pages of several scenarios, as one page that leads to them.
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

/// "34 of 36 scenarios hold; fault-late: …, …": the total, and what does not.
Verdict index_verdict(const std::vector<IndexLine>& lines);

/// A line each with a link, those that fail first; the total above.
Report scenario_index(const std::vector<IndexLine>& lines);

}  // namespace host
