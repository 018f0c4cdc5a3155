// Jerk-limited speed profile along a path, from rest to rest, within the limits of each part.
#pragma once

#include <functional>
#include <vector>

namespace host {

/// Limits of the motion along a path.
struct TangentialLimits {
  double acceleration = 0.0;  ///< mm/s^2
  double jerk = 0.0;          ///< mm/s^3
};

/// A part of a path, between two lengths along it, mm.
struct SpeedInterval {
  double begin = 0.0, end = 0.0;
  double speed = 0.0;                              ///< mm/s
  std::function<TangentialLimits(double)> limits;  ///< limits that hold up to a given speed
};

/// A phase of constant jerk.
struct SpeedPhase {
  double duration_s = 0.0;
  double jerk = 0.0;  ///< mm/s^3
};

struct SpeedState {
  double length = 0.0, speed = 0.0, acceleration = 0.0;
};
SpeedState after(const SpeedState& state, double time_s, double jerk);

/// Profile over consecutive intervals without gaps, from rest at the beginning of the first to rest at the end of the
/// last. It rises to the lowest speed that the intervals allow, then between the limiting intervals to the next lowest,
/// and so on. The acceleration is 0 where a limit begins or ends to apply, and elsewhere only if necessary.
std::vector<SpeedPhase> speed_profile(const std::vector<SpeedInterval>& intervals);

}  // namespace host
