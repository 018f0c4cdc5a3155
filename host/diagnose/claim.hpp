// The criteria for claiming a candidate. They become stricter with the number of tried candidates and looser with the
// number of validation windows.
#pragma once

#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"
#include "host/search/explained_share.hpp"

namespace host {

/// By chance, the best of all candidates lowers the error of a complete model by up to 1.6 %; a gain below 5 % is never
/// claimed.
inline constexpr double kLeastGain = 0.05;

/// Candidates whose levels differ by a smaller share are not told apart.
inline constexpr double kTie = 0.05;

/// The same share of a candidate, on the set of which it is smaller.
double explained_by(const JudgedCandidate& candidate, const Diagnosis& diagnosis);

/// Geometric mean of both levels.
double level_of_both(const SetLevels& level);

/// Whether one candidate has the lower level, and the lower level or combined error by more than `share`.
bool is_better(const JudgedCandidate& one, const JudgedCandidate& other, double share);

/// explained_share() of what one candidate leaves by another, on both sets. A set at its noise floor has nothing left.
double explained_beyond(const JudgedCandidate& less, const JudgedCandidate& more);

/// Number of parameters that a candidate adds to the base.
std::size_t parameters_of(const JudgedCandidate& candidate);

/// The reason why a candidate is not claimed.
enum class Reservation {
  none,
  no_gain,      ///< it lowers the error too little, or not on both training and validation data
  on_bound,     ///< a parameter reached a bound of its physical range
  leaves_much,  ///< it leaves more error than a true cause would: it stands in for another effect
  luck,         ///< too few validation windows to exclude that the best of all candidates gained by chance
};

/// The first reservation, in the order above.
Reservation reservation_about(const JudgedCandidate& candidate, const Diagnosis& diagnosis);

/// Seconds of validation data for which an improvement in all windows is significant for the best of `tried`
/// candidates.
double least_validation_s(std::size_t tried);

}  // namespace host
