// A diagnosis that continues from the prior odds before a planned run.
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
  double expected_odds = 0.0;  ///< stated by the plan; 0: none
};

/// Throws Failure(bad_input) naming the file and the remedy.
Beliefs read_beliefs(const std::string& path);

/// Whether `axistool excite` made this record from a planned run.
bool is_planned_run(const Record& record);

/// Fits the rivals to the records that are not planned runs, and decides by those that are. Throws Failure(usage) if
/// the training records lack either kind, and what fit_rivals() throws.
Decision decide(const sim::DriveDescription& model, const Beliefs& beliefs, const Measurements& measured);

/// Applies a decision to a diagnosis of the same records: the rivals share their total probability as the decision
/// says. If the verdict names one of them, it then names the remaining ones.
void apply(const Decision& decision, const Beliefs& beliefs, Diagnosis& diagnosis);

}  // namespace host
