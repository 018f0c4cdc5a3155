// What an identification is for. Least squares of the torque (eqs. 20 to 40) and a fit of the free motion are two ends
// of one likelihood (Erkorkmaz & Altintas 2001, p. 1497: maximum likelihood "would be best"): the shorter the
// predictions, the more the torque's error counts, and the longer, the more the motion's.
#pragma once

#include <nlohmann/json.hpp>

#include "host/identify/identification.hpp"

namespace host {

/// Length of the predictions that are fitted unless asked otherwise. On EMPS, longer ones cost the torque more than
/// they gain the motion (tests/MEASURED.md).
inline constexpr double kPredictionWindow_s = 0.1;

struct PredictionFit {
  double window_s = 0.0;
  double before = 0.0, after = 0.0;    ///< error over noise floor in these windows
  double relative_error_before = 0.0;  ///< of torque or force, by the estimate that it began with
};

/// Fits inertia and friction of `found` again, to the motion predicted in windows of this length, each error weighted
/// by the noise floor that the judge of models uses. Changes its model, estimate and relative error. Throws
/// Failure(bad_input) for records shorter than a window.
PredictionFit fit_for_prediction(Identification& found, const Measurements& measured, double window_s);

/// {"window_s", "before", "after", "relative_error_before"}.
nlohmann::json prediction_json(const PredictionFit& fit);

}  // namespace host
