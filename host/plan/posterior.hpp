// A diagnosis that uses the prior odds from before a planned run.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/plan/decision.hpp"
#include "host/record/measurements.hpp"

namespace host {

/// The alternatives of a plan (`axis-plan/1`), a decision, or an ambiguous diagnosis (`axis-diagnosis/1`), without
/// models.
struct Beliefs {
  std::vector<Rival> rivals;
  double expected_odds = 0.0;  ///< odds stated by the plan; 0 if there are none
};

/// Throws Failure(bad_input) with the file and the remedy.
Beliefs read_beliefs(const std::string& path);

/// Whether `axistool excite` made this record from a planned run.
bool is_planned_run(const Record& record);

/// Fits the rivals to the records that are not planned runs, and decides by the planned runs. Throws Failure(usage) if
/// the training records lack either kind, and what fit_rivals() throws.
Decision decide(const sim::DriveDescription& model, const Beliefs& beliefs, const Measurements& measured);

/// Applies a decision to a diagnosis of the same records: divides the total probability of the rivals among them by the
/// decision. If the verdict names one of them, it then names the remaining ones.
void apply(const Decision& decision, const Beliefs& beliefs, Diagnosis& diagnosis);

}  // namespace host
