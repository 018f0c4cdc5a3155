// Holds the feed of a path when the force of the process on an axis exceeds its limit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/app/core_units.hpp"

namespace firmware {

/// The force is the estimator's disturbance while the axis moves; it contains friction unless feed-forward covers it.
/// The limit is feedback.hold_effort. The feed stays held until the host releases it. At rest, and for a moment after a
/// start, the estimate holds the static friction, and it is noisy: the feed is held once 30 ms more were above the
/// limit than below it.
template <typename Application>
class ProcessLimit {
 public:
  /// For the background, once after each control period that it sees.
  [[gnu::noinline]] void poll(Application& app) {
    for (std::size_t axis = 0; axis < Application::kAxes; ++axis) {
      const AxisValues values = app.active().axis(axis);
      const bool is_on =
          values.get<"feedback.hold_effort">() > 0.0F && app.path().is_moving() && app.path().leads(axis);
      if (!is_on)
        excess_[axis] = 0;
      else if (exceeds(app, axis, values))
        ++excess_[axis];
      else if (excess_[axis] > 0)
        --excess_[axis];
      const auto rate_Hz = static_cast<std::uint32_t>(app.active().template get<"control.rate">());
      if (excess_[axis] > rate_Hz / kLeastShare) app.path().hold_for_process();
    }
  }

 private:
  static constexpr std::uint32_t kLeastShare = 33;  ///< of a second

  static bool exceeds(Application& app, std::size_t axis, const AxisValues& values) {
    typename Application::Number disturbance, velocity;
    {
      const typename Application::BoardType::ControlShutOut guard;
      disturbance = app.axes()[axis].telemetry().estimate.disturbance;
      velocity = app.axes()[axis].telemetry().reference_velocity;
    }
    const float effort = from_core_voltage(disturbance, values) * values.get<"drive.effort_per_volt">();
    const float speed = from_core_velocity(velocity, values);
    const float limit = values.get<"feedback.hold_effort">(), blend = values.get<"friction.blend">();
    return (effort > limit || effort < -limit) && (speed > blend || speed < -blend);
  }

  std::array<std::uint32_t, Application::kAxes> excess_{};  ///< control periods above the limit less those below
};

}  // namespace firmware
