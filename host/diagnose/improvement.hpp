// Diagnoses and adds effects until none is significant on validation data; records the errors step by step.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/fit/model_fit.hpp"

namespace host {

/// One step: the effects added since the previous step, and the errors of the model with them.
struct Rung {
  std::vector<std::string> added;
  double train = 0.0, validate = 0.0;  ///< combined, in the measure that decided
  ErrorOnSets error;                   ///< as compare prints it
};

struct Improvement {
  std::vector<Rung> ladder;  ///< the base re-fitted first
  std::string stopped_because;
  DiagnosisVerdict verdict;  ///< of the last step
  sim::DriveDescription model;
  Diagnosis first;    ///< the diagnosis that the ladder began with
  ErrorOnSets error;  ///< of `model`
  /// True if `model` is the given one, because the model of the last step predicts held-back records worse.
  bool kept_given = false;
  bool is_refused = false;  ///< kept_given after a step that added an effect or clearly raised the error
};

/// Largest number of steps; no drive has needed as many.
inline constexpr int kMostRungs = 5;

/// Never adds an effect that does not replicate on validation data, nor a kind in `absent`. `known`: the diagnosis of
/// this model on these measurements, if it exists already. Throws as diagnose() does.
Improvement improve(const sim::DriveDescription& model, const Measurements& measured, const ShareDone& progress = {},
                    const std::vector<std::string>& absent = {}, std::optional<Diagnosis> known = std::nullopt,
                    int most_rungs = kMostRungs);

/// The model with effects added at their best fit, whether they are significant or not. Every parameter carries its 95
/// % interval and `from`. Throws Failure(usage) if an effect cannot be added to this model or does not show in these
/// records.
struct Addition {
  JudgedCandidate judged;  ///< its confidence is that of the last effect
  std::vector<ParameterEstimate> estimates;
  bool held_back = false;
  ErrorOnSets given, error;  ///< of the given model, and with the effects
  /// The model with the effects predicts held-back records worse, so the returned model is the given one.
  bool kept_given = false;
};
Addition add_effects(const sim::DriveDescription& model, const std::vector<std::string>& kinds,
                     const Measurements& measured);

/// The model with a curve over a coordinate added. If `over` is empty, the coordinate with the smallest validation
/// error is used. A curve can take any shape and gives no cause. Throws Failure(refused) if no curve lowers the error.
Addition add_free_curve(const sim::DriveDescription& model, const std::string& over, const Measurements& measured);

/// Writes intervals and origin into a fitted model; returns the estimate of each parameter.
std::vector<ParameterEstimate> document_fit(sim::DriveDescription& model, const RecordSet& training);

}  // namespace host
