// The criteria for claiming a candidate. They become stricter with the number of tried candidates and looser with the
// number of validation windows.
#pragma once

#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"

namespace host {

/// An error of a complete model, over its floor: made cases without any effect leave 0.8 to 1.05.
inline constexpr double kComplete = 1.0;

/// Largest p-value of an improvement that is claimed.
inline constexpr double kMostLuck = 0.05;

/// By chance the best of all candidates lowers the error of a complete model by up to 1.6 %; nothing is claimed below 5
/// %.
inline constexpr double kLeastGain = 0.05;

/// Part of what there is to explain, before^2 - kComplete^2, that is gone, 0..1. 0 where there was nothing.
double explained_share(double before, double after);

/// The same share on the training data, with or without the windows of late breakaways or impacts, whose instant no
/// model predicts.
double explained_in_training(const JudgedCandidate& candidate, const Diagnosis& diagnosis);

/// That a candidate adds to the base.
std::size_t parameters_of(const JudgedCandidate& candidate);

/// Why a candidate is not claimed.
enum class Reservation {
  none,
  no_gain,      ///< it lowers too little of the error, or not on training and validation alike
  on_bound,     ///< a parameter ran to the end of its physical range
  leaves_much,  ///< what it leaves is too much for an effect that is really there: it makes up for something else
  luck,         ///< too few windows judged it to rule out that the best of all that were tried was lucky
};

/// The first reservation, in the order above.
Reservation reservation_about(const JudgedCandidate& candidate, const Diagnosis& diagnosis);

/// Parameters of the effects in `kinds` that stand at the end of their range, "compliance: damping_ratio". A bound at
/// zero means that this part of the effect is absent, which is allowed.
std::vector<std::string> parameters_on_bound(const sim::DriveDescription& model, const std::vector<std::string>& kinds);

/// Seconds of validation data for which an improvement in all windows is significant for the best of `tried`
/// candidates.
double least_validation_s(std::size_t tried);

}  // namespace host
