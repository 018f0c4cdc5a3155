// A brake that holds without current, on a simulated drive.
#pragma once

#include <cmath>

#include "sim/plant.hpp"

namespace hal::pc {

struct BrakeWiring {
  double deceleration = 0.0;     ///< deceleration in addition to friction, rad/s^2 (m/s^2); 0: no brake
  double release_time_s = 0.05;  ///< from switching the current on until the brake is released
  double apply_time_s = 0.05;    ///< from switching the current off until the brake holds
};

/// Initially fully applied. Either its whole torque acts or none.
class SimulatedBrake {
 public:
  SimulatedBrake(sim::Plant& plant, const BrakeWiring& wiring)
      : plant_(plant), wiring_(wiring), since_s_(wiring.apply_time_s) {}

  void set_released(bool released) {
    if (released != is_released_) since_s_ = 0.0;
    is_released_ = released;
  }
  bool holds() const {
    return wiring_.deceleration > 0.0 &&
           (is_released_ ? since_s_ < wiring_.release_time_s : since_s_ >= wiring_.apply_time_s);
  }

  /// Call it after the plant has advanced by `duration_s` from the travel `x` and the speed `w`.
  void act(double x, double w, double duration_s) {
    if (holds()) {
      sim::DriveState& truth = plant_.truth();
      const double slower = wiring_.deceleration * duration_s;
      truth.w = truth.load_w = std::abs(truth.w) <= slower ? 0.0 : truth.w - std::copysign(slower, truth.w);
      truth.x = truth.load_x = x + (w + truth.w) / 2.0 * plant_.data().lead * duration_s;
    }
    since_s_ += duration_s;
  }

 private:
  sim::Plant& plant_;
  BrakeWiring wiring_;
  bool is_released_ = false;
  double since_s_;
};

}  // namespace hal::pc
