// Evaluates the result of a search: errors on both sets, comparison of candidates, verdict.
#pragma once

#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/search/candidate_search.hpp"
#include "host/search/search_by_steps.hpp"

namespace host {

/// A candidate's result on validation data relative to the base, as the best of `tried` candidates.
JudgedCandidate judge_candidate(const Candidate& candidate, const RecordSet& training, const RecordSet& validation,
                                const SetError& before, std::size_t tried);

/// Fills errors, regions, candidates and verdict of `diagnosis`, whose sets and base must be set; `given` is the model
/// before its refit. The noise floors become those of the best model found.
void judge(Diagnosis& diagnosis, const sim::DriveDescription& given, const Findings& findings);

}  // namespace host
