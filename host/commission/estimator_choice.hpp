// The disturbance variance Rwd of the estimator, chosen by tracking tests (Erkorkmaz & Altintas 2001, p. 1503).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/identify/force_estimate.hpp"
#include "host/record/record.hpp"
#include "host/response/compliance.hpp"

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
  Compliance compliance;              ///< of the designed loop
  ForceEstimate force;                ///< what its estimator says about a process force
  std::string unusable_because;       ///< no margin, or a fault; the figures of the runs are then missing
};

/// What an estimator must allow.
struct EstimatorDemand {
  Compliance first;               ///< with the first estimator, at the same margin
  std::optional<double> force_N;  ///< amplitude of the process force that the axis has to bear, if it is known
  double most_noise_V = 0.0;      ///< of the command, RMS
};

struct EstimatorChoice {
  std::optional<std::size_t> value;  ///< empty if no value is allowed
  std::string why;                   ///< without a full stop
};

/// Noise of the command, V RMS of one run: what differs between two runs of the same motion. From the median of its
/// size, so that a few moments at which friction lets go earlier or later do not count. Throws Failure(bad_input) for a
/// record without a moving reference.
double command_noise_V(const Record& once, const Record& again);

/// Deviation from the reference, µm RMS: following error and, independent of it, the response to a force of this
/// amplitude at the frequency where the axis is softest.
double deviation_um(double error_um, const Compliance& compliance, std::optional<double> force_N);

/// Whether `one` is softer by more than one step of highest_bandwidth() makes it.
bool is_softer(const Compliance& one, const Compliance& other);

/// `tests`: in the order of rising Rwd. Chooses among the values that the demand allows: the least noisy one whose
/// deviation equals the smallest one within the difference of equal runs. A larger Rwd rejects disturbances better
/// (p. 1503), but the following error shows that only under a process force. At a given margin, compliance falls as
/// noise grows over decades of Rwd, so no value of Rwd stands out. The deviation under a given force therefore decides.
/// Without a force, no value may make the axis softer than the first estimator does.
EstimatorChoice choose_estimator(const std::vector<TrackingTest>& tests, const EstimatorDemand& demand);

/// {"tried": [...], "chosen_V2", "why", …}; figures of unusable values are null.
nlohmann::json tracking_json(const std::vector<TrackingTest>& tests, const EstimatorDemand& demand,
                             const EstimatorChoice& choice);

}  // namespace host
