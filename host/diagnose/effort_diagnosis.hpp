// Diagnosis by force-balance regression, for records without acceleration and for errors far above sensor noise. Least
// squares decides; forward prediction is shown beside it.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/diagnose/diagnosis.hpp"
#include "host/effort/effort_screen.hpp"

namespace host {

/// Residual over sensor noise on the validation rows, or on the training rows.
double over_noise(const EffortScreen& screen, const ScreenedModel& model, bool judges);

/// A model of the regression as a candidate, its errors over the sensors' noise.
JudgedCandidate judged_by_effort(const EffortScreen& screen, const ScreenedModel& model);

/// Whether the regression decides instead of the search by motion: the records do not determine the inertia, or the
/// best model's residual is far above sensor noise.
bool effort_decides(const EffortScreen& screen, const RecordSet& validation);

/// The regression on sets that move enough, up to the number of effects that a diagnosis names.
std::shared_ptr<const EffortScreen> screen_of(const sim::DriveDescription& model, const PreparedSets& sets);

/// The diagnosis by a regression with a result, whichever measure decides. `sets`: of the same records.
Diagnosis diagnosis_of(const sim::DriveDescription& model, const PreparedSets& sets,
                       std::shared_ptr<const EffortScreen> screen);

/// The first step of the regression, on sets that move enough: the odds of one effect, whichever measure would decide.
std::shared_ptr<const EffortScreen> first_step_of(const sim::DriveDescription& model, const PreparedSets& sets);

/// Errors of the forward prediction closer than this ratio count as equal.
inline constexpr double kHardly = 0.98;

/// Result of the forward prediction for the chosen effects, as a sentence; may be empty.
std::string said_by_the_motion(const Diagnosis& diagnosis);

/// If unexplained: names the coordinate that carries most of the residual, and the share that a free curve explains.
void name_coordinate(Diagnosis& diagnosis);

/// Result of the regression: relative errors of torque or force, the channel of the motion, held parameters.
nlohmann::json effort_screen_json(const EffortScreen& screen);

}  // namespace host
