// The disturbance variance Rwd of the estimator, chosen by tracking tests (Erkorkmaz & Altintas 2001, p. 1503).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/record/record.hpp"

namespace host {

/// One value of Rwd and what the machine did with it.
struct TrackingTest {
  double disturbance_variance = 0.0;  ///< Rwd, V^2 per sample
  double bandwidth_Hz = 0.0;          ///< of the loop's poles
  double observer_Hz = 0.0;           ///< slowest pole of the estimator
  std::optional<double> modulus;      ///< margin on the measured response, if there is one
  double error_um = 0.0;              ///< following error, RMS; mean of two equal runs
  double repeats_um = 0.0;            ///< difference between these runs
  double noise_V = 0.0;               ///< of the command, RMS
  std::string unusable_because;       ///< no margin, or a fault; the figures of the runs are then missing
};

struct EstimatorChoice {
  std::optional<std::size_t> knee;  ///< empty if no value is usable
  std::string why;                  ///< without a full stop
};

/// Noise of the command, V RMS of one run: what differs between two runs of the same motion. From the median of its
/// size, so that a few moments at which friction lets go earlier or later do not count. Throws Failure(bad_input) for a
/// record without a moving reference.
double command_noise_V(const Record& once, const Record& again);

/// `tests`: in the order of rising Rwd. Starts at the calmest value that was run. Takes the next one as long as its
/// error is smaller by more than equal runs differ, and by a larger factor than that by which its noise is larger. The
/// product of error and noise is then at its first minimum, where the curve has the slope -1 on logarithmic scales
/// (Regińska, SIAM J. Sci. Comput. 17, 1996, p. 740, for the corner of an L-curve). Values beyond the next one have no
/// influence.
EstimatorChoice choose_estimator(const std::vector<TrackingTest>& tests);

/// {"tried": [...], "chosen_V2", "why"}; figures of unusable values are null.
nlohmann::json tracking_json(const std::vector<TrackingTest>& tests, const EstimatorChoice& choice);

}  // namespace host
