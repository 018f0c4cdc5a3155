// Equivalent forms of the same measurements: a change without effect on the physics must not change the diagnosis.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/record/record.hpp"
#include "host/scoreboard/trial.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Input of a diagnosis, before the gate.
struct Question {
  sim::DriveDescription model;
  std::vector<Record> train, validate;  ///< adapted to the model; `validate` may be empty
};

/// Throws Failure(bad_input) for a bad file.
Question read_question(const Trial& trial);

/// A way to rewrite a question.
struct Rewriting {
  std::string_view name;  ///< "volt x 100"
  std::function<void(Question&)> apply;
  /// Expected value of a fitted base parameter after rewriting, from its id and value in the original. Empty:
  /// unchanged.
  std::function<double(const Question&, std::string_view id, double)> expected = {};
};

/// Volts scaled by 100 and 0.01 (with the data sheet), a rotary drive converted to a linear one, direction mirrored,
/// time shifted, training records in reverse order, the first of them cut in two, and given twice.
std::span<const Rewriting> rewritings();

/// Answer to a rewritten question compared with the original.
struct Invariance {
  bool same_verdict = false;        ///< same status and effects
  double worst_parameter = 0.0;     ///< largest difference of a base parameter; 1: both 95 % intervals just touch
  double error_ratio = 1.0;         ///< ratio of the larger to the smaller validation error
  std::string original, rewritten;  ///< both verdicts in words
};

/// Diagnoses a question and its rewritten forms; returns one result for each of `chosen`.
std::vector<Invariance> try_rewritings(const Question& question, std::span<const Rewriting> chosen);

}  // namespace host
