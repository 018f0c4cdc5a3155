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

/// Throws Failure(bad_input) naming the file and what mends it.
Beliefs read_beliefs(const std::string& path);

/// A record that `axistool excite` made of a planned run.
bool is_planned_run(const Record& record);

/// Fits the rivals to the records that are no planned runs, and decides by those that are. Throws Failure(usage) where
/// the training records hold none of the one or the other kind; what fit_rivals() throws.
Decision decide(const sim::DriveDescription& model, const Beliefs& beliefs, const Measurements& measured);

/// Puts a decision into a diagnosis of the same records: the rivals share the probability that the diagnosis gives all
/// of them as the decision says, and where it names one of them the verdict names those that are left.
void apply(const Decision& decision, const Beliefs& beliefs, Diagnosis& diagnosis);

}  // namespace host
