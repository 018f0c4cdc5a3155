// How probable each answer is: every candidate, that nothing is missing, that something else is.
#pragma once

#include "host/diagnose/diagnosis.hpp"

namespace host {

/// Constants of the probabilities, calibrated on made cases whose truth is known (axistool scoreboard
/// shows how well).
struct ProbabilityScale {
  double tie = 0.05;          ///< log error by which a rival's odds fall to 1/e
  double further = 0.15;      ///< log error that a second effect must bring to be worth its place
  double parameter = 0.01;    ///< the same for each parameter beyond those of the simplest candidate
  double bound = 0.15;        ///< the same for a parameter at the end of its range
  double complete = 1.25;     ///< error over floor at which a base is as probably complete as not
  double complete_by = 0.05;  ///< width of that step in log error, with many windows
  double unshown = 1.8;       ///< log odds off "nothing" where the records would not have shown all that may be missing
  double traced = 3.0;        ///< the same where what is left is small but no noise
  double other_at = 0.12;     ///< unexplained part at which something else is as probable as the best candidate
  double other_slope = 2.4;   ///< of the log odds over the log of that part
  double lapse = 0.05;        ///< "something else" however well a candidate explains: on cuts one such answer in 16
  double rough = 3.5;  ///< log odds that a rough machine, which lacks many small things, takes off "something else"
  // For effects that meet all criteria of a claim (claim.hpp, effort_screen.cpp). Their residual may have further
  // causes, which does not make them less probable.
  double lapse_of_claim = 0.01;  ///< `lapse`: of 133 records that were cut, faulty or rewritten one claim was wrong
  /// `other_at` and `other_slope`: what is no effect of the catalogue left 0.2 and more of the squared error of made
  /// machines, and on rough ones 0.65 and more, where right claims left up to 0.55.
  double other_at_claim = 0.3, other_slope_claim = 6.0, rough_claim = 5.8;
  double gained = 3.0;  ///< log odds off "nothing": what was claimed is beyond chance
};

/// Fills `probability` of all candidates and both probabilities of the verdict, whose status is known; together they
/// are 1.
void assign_probabilities(Diagnosis& diagnosis, const ProbabilityScale& scale = {});

}  // namespace host
