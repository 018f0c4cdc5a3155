// Decides the status of a verdict from the candidates' probabilities and the losses of wrong answers.
#pragma once

#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/infer/posterior.hpp"

namespace host {

/// Largest group of rivals: one further measurement can separate this many.
inline constexpr std::size_t kLargestGroup = 4;
/// Whether a list of kinds contains all of these.
bool holds_all(const std::vector<std::string>& all, const std::vector<std::string>& kinds);
/// Probability of all these effects together: the sum over all candidates that contain them.
double probability_of(const Diagnosis& diagnosis, const std::vector<std::string>& kinds);

/// Withdraws names whose probability is too low. Effects stay named while they hold kClaimed together; of the others,
/// rivals that hold it beside them are a group. Where no name is left, a group whose members exceed kWorthNaming and of
/// which one is present with kClaimed is named as ambiguous; otherwise the verdict is unexplained.
void settle_status(Diagnosis& diagnosis);

/// Effects of the verdict's model: the named ones, and the first of each group of which one is certain. For an
/// ambiguous verdict, the first of its group.
std::vector<std::string> modelled_kinds(const Diagnosis& diagnosis);

/// Fills the certain effects and the remaining error, once the models' errors and the best model's residual are known.
void fill_found(Diagnosis& diagnosis);

}  // namespace host
