// Fits an identified model for prediction. Least squares of the torque (eqs. 20 to 40) and a fit of the free motion are
// the two limits of one maximum-likelihood fit (Erkorkmaz & Altintas 2001, p. 1497: maximum likelihood "would be
// best"). With shorter predictions the error of the torque has more weight, with longer ones the error of the motion.
#pragma once

#include <nlohmann/json.hpp>

#include "host/identify/identification.hpp"

namespace host {

/// Default length of the predictions that are fitted. On EMPS, longer predictions increase the torque error by more
/// than they reduce the motion error (tests/MEASURED.md).
inline constexpr double kPredictionWindow_s = 0.1;

struct PredictionFit {
  double window_s = 0.0;
  double before = 0.0, after = 0.0;    ///< error over noise floor in these windows
  double relative_error_before = 0.0;  ///< relative error of torque or force before this fit
};

/// Fits inertia and friction of `found` again, to the motion predicted in windows of this length. Each error is
/// weighted by the noise floor that compare uses. Changes the model, the estimate and the relative error of `found`.
/// Throws Failure(bad_input) for records shorter than a window.
PredictionFit fit_for_prediction(Identification& found, const Measurements& measured, double window_s);

/// {"window_s", "before", "after", "relative_error_before"}.
nlohmann::json prediction_json(const PredictionFit& fit);

}  // namespace host
