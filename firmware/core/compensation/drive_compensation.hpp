// Feed-forward of effects besides inertia, from the reference alone.
#pragma once

#include "firmware/core/compensation/compensation_parameters.hpp"
#include "firmware/core/control/friction_feedforward.hpp"

namespace firmware {

/// Extends the friction feed-forward by cogging, friction that varies along the travel, presliding, and friction that
/// does not act on the motor inside a gap. For an axis without any of them, is_on() is the only cost.
template <typename Scalar>
class DriveCompensation {
 public:
  constexpr void configure(const CompensationParameters<Scalar>& parameters, bool friction_on,
                           const FrictionParameters<Scalar>& friction, Scalar sample_period_s) {
    parameters_ = parameters;
    friction_on_ = friction_on;
    presliding_on_ = friction_on && parameters.presliding.on;
    varies_ = friction_on && parameters.position_friction_on;
    is_on_ = parameters.cogging_on || presliding_on_ || varies_ || (friction_on && parameters.backlash.on);
    if (presliding_on_) presliding_.configure(parameters.presliding, friction, sample_period_s);
  }

  constexpr bool is_on() const { return is_on_; }
  constexpr void reset() { presliding_.reset(); }
  constexpr void feed_friction(bool on) { friction_on_ = on; }

  /// Volts for the period in which the reference moves at `velocity`; `middle` is its position halfway. Effects that
  /// depend on the position (cogging, friction along the travel) act only if `middle` is counted from home.
  constexpr Scalar advance(const FrictionFeedforward<Scalar>& friction, const BacklashCrossing& backlash,
                           Scalar velocity, const CountPosition& middle, bool homed) {
    Scalar sum = friction_on_ ? friction_V(friction, backlash, velocity, middle, homed) : Scalar(0);
    if (!parameters_.cogging_on || !homed) return sum;
    for (const TravelHarmonic<Scalar>& harmonic : parameters_.cogging_V)
      if (!harmonic.is_zero()) sum = sum - harmonic(middle);
    return sum;
  }

 private:
  constexpr Scalar friction_V(const FrictionFeedforward<Scalar>& friction, const BacklashCrossing& backlash,
                              Scalar velocity, const CountPosition& middle, bool homed) {
    Scalar sliding_V = presliding_on_ ? friction.without_blend(velocity) : friction(velocity);
    if (varies_ && homed) sliding_V = sliding_V + sliding_V * parameters_.position_friction(middle);
    if (backlash.is_on() && backlash.is_crossing()) {
      const Scalar carried = backlash.carried<Scalar>();
      sliding_V = velocity < Scalar(0) ? Scalar(0) - sliding_V * carried : sliding_V * carried;
    }
    return presliding_on_ ? presliding_.advance(velocity, sliding_V) : sliding_V;
  }

  bool is_on_ = false;  // comes first, so that one load of every step reaches it
  bool friction_on_ = false, presliding_on_ = false, varies_ = false;
  PreslidingFriction<Scalar> presliding_;
  CompensationParameters<Scalar> parameters_{};
};

}  // namespace firmware
