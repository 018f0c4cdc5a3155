// Decides the status of a verdict from the candidates' probabilities and the losses of wrong answers.
#pragma once

#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/infer/posterior.hpp"

namespace host {

/// Whether a list of kinds contains all of these.
bool holds_all(const std::vector<std::string>& all, const std::vector<std::string>& kinds);
/// Probability that all these effects are present: the sum over all candidates that contain them.
double probability_of(const Diagnosis& diagnosis, const std::vector<std::string>& kinds);

/// Withdraws effects whose probability is too low. Effects stay named if they are present together with a probability
/// of at least kClaimed. Of the other effects, rivals form a group if one of them is present beside the named ones with
/// at least kClaimed. If no effect can be named, the verdict is ambiguous if there is a group of which each effect
/// exceeds kWorthNaming and one is present with at least kClaimed; otherwise it is unexplained.
void settle_status(Diagnosis& diagnosis);

/// Effects of the verdict's model: the named ones, and the first of each group of rivals. For an ambiguous verdict, the
/// first of its group.
std::vector<std::string> modelled_kinds(const Diagnosis& diagnosis);

/// Fills the certain effects and the remaining error. Needs the models' errors and the best model's residual.
void fill_found(Diagnosis& diagnosis);

}  // namespace host
