// A drive of one mass and some modes on springs, fitted to a measured frequency response.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "host/response/frequency_response.hpp"

namespace host {

/// A value and its 95 % interval.
struct Interval95 {
  double value = 0.0;
  std::array<double, 2> ci95{};
};

/// Two masses on a spring, free to move; damping of that mode.
struct Resonance {
  Interval95 f_Hz, damping;
  /// The mode's part in position and in speed, against the rigid part. Two masses seen at the motor: load's inertia
  /// over motor's; seen at the load: -1.
  double position_share = 0.0, speed_share = 0.0;
};

/// Position: Kx e^(-s delay) / (1 + s lag) (1 / (s (s + p)) + sum of r / (s^2 + 2 zeta w s + w^2)); speed: likewise
/// times s, with a gain and a delay of its own; all behind a hold, as sampled.
struct PlantFit {
  double sample_period_s = 0.0;
  double position_gain = 0.0;  ///< mm/s^2 (m/s^2) per V
  double speed_gain = 0.0;     ///< rad/s^2 (m/s^2) per V
  double pole = 0.0;           ///< p, 1/s: viscous friction over inertia
  Interval95 delay_s;          ///< of the drive, beyond the hold
  Interval95 lag_s;            ///< of its current loop: 1 / (2 pi bandwidth). Of delay and lag one is 0
  double speed_delay_s = 0.0;  ///< of the tachometer beyond that
  std::vector<Resonance> resonances;
  double misfit = 0.0;  ///< root mean square of what is left, in the lines' own standard deviations

  Eigen::Vector2cd at(double f_Hz) const;
};

/// What a model says of the same: inertia, viscous friction, input_delay, current_loop_lag, compliance. Other effects
/// are left out. Throws as rigid_axis().
PlantFit plant_of(const sim::DriveDescription& model);

/// Modes are added while each explains more than chance would; what turns the phase is a lag where magnitudes fall as
/// its do, otherwise a delay. Throws Failure(refused) for fewer than six lines.
PlantFit fit_plant(const FrequencyResponse& response);

}  // namespace host
