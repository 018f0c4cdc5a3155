// Diagnosis by force-balance regression, for records without acceleration and for errors far above sensor noise. Least
// squares of the torque or force decides; the prediction of the motion is reported beside it.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/diagnose/diagnosis.hpp"
#include "host/effort/effort_screen.hpp"

namespace host {

/// RMS residual over sensor noise on the validation rows (`judges`), or on the training rows.
double over_noise(const EffortScreen& screen, const ScreenedModel& model, bool judges);

/// A model of the regression as a candidate, with its errors over sensor noise.
JudgedCandidate judged_by_effort(const EffortScreen& screen, const ScreenedModel& model);

/// Share of the RMS error below which it counts as explained: a tenth of the squared error.
inline constexpr double kExplainedPart = 0.316;

/// Whether the effects of the regression explain its residual.
bool is_explained(const EffortScreen& screen);

/// Whether the regression decides instead of the search by motion: the records do not determine the inertia, or the
/// best model's residual is far above sensor noise.
bool effort_decides(const EffortScreen& screen, const RecordSet& validation);

/// The regression on sets with enough motion, up to the largest number of effects in one diagnosis.
std::shared_ptr<const EffortScreen> screen_of(const sim::DriveDescription& model, const PreparedSets& sets);

/// The diagnosis by a regression that has a result, even if the search by motion would decide. `sets`: of the same
/// records.
Diagnosis diagnosis_of(const sim::DriveDescription& model, const PreparedSets& sets,
                       std::shared_ptr<const EffortScreen> screen);

/// The first step of the regression on sets with enough motion: the odds of single effects, even if the search by
/// motion would decide.
std::shared_ptr<const EffortScreen> first_step_of(const sim::DriveDescription& model, const PreparedSets& sets);

/// Two errors of the prediction of the motion count as equal if their ratio is above this.
inline constexpr double kHardly = 0.98;

/// Whether the prediction of the motion confirms the chosen effects, as a sentence; may be empty.
std::string said_by_the_motion(const Diagnosis& diagnosis);

/// If unexplained: names the coordinate on which the residual depends most, and the share that a free curve explains.
void name_coordinate(Diagnosis& diagnosis);

/// Result of the regression: relative errors of torque or force, the channel that gave the motion, held parameters.
nlohmann::json effort_screen_json(const EffortScreen& screen);

}  // namespace host
