// Fits a rigid mass with a few spring modes to a measured frequency response.
#pragma once

#include <array>
#include <complex>
#include <optional>
#include <vector>

#include "host/response/frequency_response.hpp"

namespace host {

/// A value and its 95 % interval.
struct Interval95 {
  double value = 0.0;
  std::array<double, 2> ci95{};
};

/// A resonance of two free masses coupled by a spring.
struct Resonance {
  Interval95 f_Hz, damping;
  /// The mode's residue in position and in speed, relative to the rigid part. For two masses measured at the motor it
  /// is load inertia over motor inertia; at the load it is -1.
  double position_share = 0.0, speed_share = 0.0;
};

/// Position: Kx e^(-s delay) / (1 + s lag) (1 / (s (s + p)) + sum of r / (s^2 + 2 zeta w s + w^2)). Speed: the same
/// times s, with its own gain and delay. Both follow a zero-order hold and are sampled.
struct PlantFit {
  double sample_period_s = 0.0;
  double position_gain = 0.0;  ///< mm/s^2 (m/s^2) per V
  double speed_gain = 0.0;     ///< rad/s^2 (m/s^2) per V
  double pole = 0.0;           ///< p, 1/s: viscous friction over inertia
  Interval95 delay_s;          ///< delay of the drive, in addition to the hold
  Interval95 lag_s;            ///< lag of its current loop, 1 / (2 pi bandwidth). Either delay or lag is 0
  double speed_delay_s = 0.0;  ///< additional delay of the tachometer
  std::vector<Resonance> resonances;
  double misfit = 0.0;  ///< RMS of the residual in standard deviations of the lines

  Eigen::Vector2cd at(double f_Hz) const;
};

/// Frequency of the lowest resonance; empty without a resonance.
std::optional<double> lowest_resonance_Hz(const PlantFit& fit);

/// The same form computed from a model's inertia, viscous friction, input_delay, current_loop_lag and compliance;
/// ignores other effects. Throws as rigid_axis().
PlantFit plant_of(const sim::DriveDescription& model);

/// Adds modes while each is significant. Phase lag becomes a first-order lag if the magnitude falls accordingly,
/// otherwise a delay. Throws Failure(refused) for fewer than six lines.
PlantFit fit_plant(const FrequencyResponse& response);

}  // namespace host
