// From the candidates' probabilities to a status: the losses of wrong answers, and the decision that follows.
#pragma once

#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/infer/posterior.hpp"

namespace host {

/// The verdict keeps a name that is more probable than all else together. The probabilities are not calibrated between
/// this and kClaimed: for some real machines the right answer has 60 %.
inline constexpr double kNamed = 0.5;
/// Largest group of rivals: one further measurement can separate this many.
inline constexpr std::size_t kLargestGroup = 4;
/// Whether a list of kinds has each of these.
bool holds_all(const std::vector<std::string>& all, const std::vector<std::string>& kinds);
/// Of all these effects together, whatever else is there besides: of all candidates that hold them.
double probability_of(const Diagnosis& diagnosis, const std::vector<std::string>& kinds);

/// Takes back what the probabilities do not carry: effects stay named where the first of them holds kNamed; else the
/// group is named that together holds it and takes kWorthNaming, as ambiguous; else the verdict is unexplained.
void settle_status(Diagnosis& diagnosis);

/// What the model of the verdict holds: what it names, and the first of each group of which one is there for certain.
/// Of an ambiguous verdict the first of its group.
std::vector<std::string> modelled_kinds(const Diagnosis& diagnosis);

/// Fills what is certain and what remains, once the errors of the models and the residual of the best are known.
void fill_found(Diagnosis& diagnosis);

}  // namespace host
