// Speed along a path: jerk-limited, from rest to rest, within the limits of each part.
#pragma once

#include <functional>
#include <vector>

namespace host {

/// Of the motion along a path.
struct TangentialLimits {
  double acceleration = 0.0;  ///< mm/s^2
  double jerk = 0.0;          ///< mm/s^3
};

/// A part of a path, between two lengths along it, mm.
struct SpeedInterval {
  double begin = 0.0, end = 0.0;
  double speed = 0.0;                              ///< mm/s
  std::function<TangentialLimits(double)> limits;  ///< that hold up to a speed
};

/// A time of constant jerk.
struct SpeedPhase {
  double duration_s = 0.0;
  double jerk = 0.0;  ///< mm/s^3
};

struct SpeedState {
  double length = 0.0, speed = 0.0, acceleration = 0.0;
};
SpeedState after(const SpeedState& state, double time_s, double jerk);

/// Over intervals that follow each other without gaps, from rest at the first's begin to rest at the last's end. Rises
/// to the lowest of the speeds that the intervals allow, then between those that bind to the next lowest, and so on:
/// the acceleration is 0 where a limit begins or ends to bind, and nowhere else without need.
std::vector<SpeedPhase> speed_profile(const std::vector<SpeedInterval>& intervals);

}  // namespace host
