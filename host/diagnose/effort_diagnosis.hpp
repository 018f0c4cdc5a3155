// The diagnosis of machines whose effort tells more than their motion: records without acceleration, and errors far
// above what the sensors make. Plain least squares decides, forward prediction is shown beside it.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/diagnose/diagnosis.hpp"
#include "host/effort/effort_screen.hpp"

namespace host {

/// Residual over the sensors' noise on the rows that judge, or on the training rows.
double over_noise(const EffortScreen& screen, const ScreenedModel& model, bool judges);

/// A model of the regression as a candidate, its errors over the sensors' noise.
JudgedCandidate judged_by_effort(const EffortScreen& screen, const ScreenedModel& model);

/// Whether the regression, not the search by motion, is to judge: no inertia shows in the records, so that any motion
/// could be predicted with a wrong one; or what the best model leaves of the effort is far above the sensors' noise.
bool effort_decides(const EffortScreen& screen, const RecordSet& validation);

/// The diagnosis by the regression, or nothing where the search by motion is to judge; `screen` is then what the
/// regression saw, where it saw anything. `sets`: of these records, split_sets() of the model. `rough`: the search by
/// motion has shown that it is not to judge. Throws as prepare_sets() does.
std::optional<Diagnosis> diagnose_by_effort(const sim::DriveDescription& model, const PreparedSets& sets,
                                            std::shared_ptr<const EffortScreen>& screen, bool rough = false);

/// What the forward prediction says of the effects that the regression chose; a sentence, empty where none is due.
std::string said_by_the_motion(const Diagnosis& diagnosis);

/// Where unexplained: names the coordinate that carries most of what is left, and says what a free curve takes of it.
void name_coordinate(Diagnosis& diagnosis);

/// What the regression saw: relative errors of the effort, the channel that it took the motion from, what it held.
nlohmann::json effort_screen_json(const EffortScreen& screen);

}  // namespace host
