// Takes friction feed-forward back while the axis follows worse with it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/app/core_units.hpp"

namespace firmware {

/// An axis follows a disturbance of its command with an error in proportion to it. The estimator tells what is left of
/// the disturbance with feed-forward, and so what would be left without it, and the reverse after it was taken back.
/// The mean squares of both are compared at the end of each stroke, from reversal or rest to the next. Feed-forward is
/// taken back after kStrokes strokes in a row with which it made the disturbance kWorse times as large, and given again
/// after as many in which it would make it as much smaller; the strokes between keep what is. A force that acts in one
/// direction only helps in every other stroke, so that it decides nothing.
class FrictionStrokes {
 public:
  static constexpr std::int32_t kStrokes = 4;
  static constexpr std::int32_t kLeastSamples = 50;  ///< of a stroke that counts
  static constexpr float kWorse = 1.5F;              ///< of mean squares

  /// A control period. `left_V`: disturbance beyond the present feed-forward; `friction_V`: of the curve at the
  /// reference, 0 at rest. Returns whether feed-forward is to be on from now on.
  constexpr bool next(float left_V, float friction_V, bool is_on) {
    const std::int32_t way = friction_V > 0.0F ? 1 : friction_V < 0.0F ? -1 : 0;
    if (way != way_) {
      if (samples_ >= kLeastSamples) judge(is_on);
      way_ = way;
      samples_ = 0;
      with_ = without_ = 0.0F;
    }
    if (way != 0) {
      const float with = is_on ? left_V : left_V - friction_V, without = is_on ? left_V + friction_V : left_V;
      with_ += with * with;
      without_ += without * without;
      ++samples_;
    }
    if (against_ < kStrokes) return is_on;
    against_ = 0;
    return !is_on;
  }
  /// Strokes before do not count any more.
  constexpr void restart() { *this = {}; }

 private:
  constexpr void judge(bool is_on) {
    const bool is_against = is_on ? with_ > kWorse * without_ : without_ > kWorse * with_;
    against_ = is_against ? against_ + 1 : 0;
  }

  float with_ = 0.0F, without_ = 0.0F;
  std::int32_t samples_ = 0;
  std::int32_t way_ = 0;
  std::int32_t against_ = 0;  ///< strokes in a row against the present state
};

/// For axes with feedforward.friction_watch.
template <typename Application>
class FrictionWatch {
 public:
  /// For the background, once after each control period that it sees.
  [[gnu::noinline]] void poll(Application& app) {
    for (std::size_t i = 0; i < Application::kAxes; ++i) {
      const AxisValues values = app.active().axis(i);
      if (values.get<"feedforward.friction_watch">() && values.get<"feedforward.friction">()) watch(app, i, values);
    }
  }

  /// Mask of the axes whose feed-forward is taken back.
  [[gnu::noinline]] static std::uint32_t taken_back(Application& app) {
    std::uint32_t mask = 0;
    for (std::size_t i = 0; i < Application::kAxes; ++i) {
      const bool is_wanted = app.active().axis(i).template get<"feedforward.friction">() && app.is_fitted(i);
      if (is_wanted && !app.axes()[i].control_law().feeds_friction()) mask |= 1u << i;
    }
    return mask;
  }

 private:
  using Number = typename Application::Number;
  using ShutOut = typename Application::BoardType::ControlShutOut;

  void watch(Application& app, std::size_t i, const AxisValues& values) {
    auto& axis = app.axes()[i];
    Number left, velocity;
    bool is_closed, is_on;
    {
      const ShutOut guard;
      left = axis.telemetry().estimate.disturbance;
      velocity = axis.telemetry().reference_velocity;
      is_closed = axis.telemetry().enabled;
      is_on = axis.control_law().feeds_friction();
    }
    if (!is_closed) return strokes_[i].restart();  // also if it is not fitted
    const float friction_V = from_core_voltage(axis.control_law().friction_at(velocity), values);
    if (strokes_[i].next(from_core_voltage(left, values), friction_V, is_on) == is_on) return;
    const ShutOut guard;
    axis.feed_friction(!is_on);
  }

  std::array<FrictionStrokes, Application::kAxes> strokes_{};
};

}  // namespace firmware
