// Probability of each answer: of every candidate, of "nothing is missing", and of "something else is missing".
#pragma once

#include "host/diagnose/diagnosis.hpp"

namespace host {

/// Constants of the probabilities, calibrated on simulated cases whose truth is known (axistool scoreboard shows how
/// well).
struct ProbabilityScale {
  double tie = 0.05;          ///< log error by which a rival's odds fall to 1/e
  double further = 0.15;      ///< decrease of the log error that makes a second effect significant
  double parameter = 0.01;    ///< the same for each parameter beyond those of the simplest candidate
  double bound = 0.15;        ///< the same for a parameter at a bound of its range
  double complete = 1.25;     ///< error over floor at which a base is complete with probability 0.5
  double complete_by = 0.05;  ///< width of this transition in log error, with many windows
  double unshown = 1.8;       ///< log odds subtracted from "nothing" if the records could not have shown every effect
  double traced = 3.0;        ///< the same if the residual is small but not white noise
  double other_at = 0.12;     ///< unexplained part at which "something else" is as probable as the best candidate
  double other_slope = 2.4;   ///< slope of the log odds over the log of that part
  double lapse = 0.05;  ///< least probability of "something else", however well a candidate explains: one answer in 16
                        ///< on cut records
  double rough = 3.5;  ///< log odds subtracted from "something else" if the machine is limited by model error: it lacks
                       ///< many small effects
  // For effects that meet all criteria of a claim (claim.hpp, effort_screen.cpp). Other causes of their residual do not
  // make them less probable.
  double lapse_of_claim = 0.01;  ///< as `lapse`: one claim in 133 cut, faulty or rewritten records was wrong
  /// As `other_at` and `other_slope`. With an effect outside the catalogue, the best candidate left at least 0.2 of the
  /// squared error of simulated machines. On machines limited by model error it left at least 0.65, while correct
  /// claims left up to 0.55.
  double other_at_claim = 0.3, other_slope_claim = 6.0, rough_claim = 5.8;
  double gained = 3.0;  ///< log odds subtracted from "nothing" after a claim, since its gain is significant
};

/// Fills `probability` of all candidates and both probabilities of the verdict, whose sum is 1. Needs the status of the
/// verdict.
void assign_probabilities(Diagnosis& diagnosis, const ProbabilityScale& scale = {});

}  // namespace host
