// Checks a run against the expectations of its scenario.
#pragma once

#include "host/hil/scenario_run.hpp"

namespace host {

CheckedExpectation check_expectation(const Expectation& expected, const ScenarioRun& run);

}  // namespace host
