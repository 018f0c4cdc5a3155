// The steps before a loop closes and after a reference has stopped: the amplifier's start and the brake.
#pragma once

#include <cstdint>

#include "hal/drive_enable.hpp"

namespace firmware {

/// Times in control periods, >= 0.
struct DriveSequenceParameters {
  bool ready_input = false;         ///< the amplifier signals when it is ready; off: it is ready after `amplifier_wait`
  bool brake_fitted = false;        ///< the brake holds the axis unless it is released
  std::int32_t amplifier_wait = 0;  ///< from the enable on; with the ready input the longest time, > 0
  std::int32_t brake_release = 0;   ///< from the release until the brake is open
  std::int32_t brake_application = 0;  ///< from the application until the brake holds the axis
};

enum class DriveStartStep : std::uint8_t {
  wait,
  close_loop,  ///< the amplifier is ready: close the loop and release the brake
  started,     ///< the axis may move
  late,        ///< the amplifier does not become ready
};

/// Always true for an amplifier without this signal.
template <hal::DriveEnable Lines>
constexpr bool is_ready(Lines& lines) {
  if constexpr (hal::ReadyInput<Lines>) return lines.is_ready();
  return true;
}

/// Order: enable, amplifier ready, loop closed, brake released, motion; at the end standstill, brake applied, enable
/// off. So the drive never works against the brake, and a vertical axis is always held by one of the two.
class DriveSequence {
 public:
  constexpr void configure(const DriveSequenceParameters& parameters) { parameters_ = parameters; }
  constexpr const DriveSequenceParameters& parameters() const { return parameters_; }

  /// Nothing to wait for: the loop closes in the control period of the enable.
  constexpr bool starts_at_once() const {
    return !parameters_.ready_input && parameters_.amplifier_wait == 0 && release_samples() == 0;
  }

  constexpr void begin() { samples_ = 0; }

  /// Once a control period after begin(), until it returns anything but wait; `loop_closed`: it has returned
  /// close_loop.
  constexpr DriveStartStep next_of_start(bool is_ready, bool loop_closed) {
    ++samples_;
    if (loop_closed) return samples_ > release_samples() ? DriveStartStep::started : DriveStartStep::wait;
    const bool waited = samples_ > parameters_.amplifier_wait;
    if (parameters_.ready_input ? is_ready : waited) {
      begin();
      return DriveStartStep::close_loop;
    }
    return waited ? DriveStartStep::late : DriveStartStep::wait;
  }

  template <hal::DriveEnable Lines>
  constexpr void release_brake(Lines& lines, bool released) const {
    if constexpr (hal::BrakeOutput<Lines>) lines.release_brake(released && parameters_.brake_fitted);
  }

  /// Once a control period after begin(), while a stopped axis is still held by its loop.
  constexpr bool brake_holds() { return !parameters_.brake_fitted || ++samples_ > parameters_.brake_application; }

 private:
  constexpr std::int32_t release_samples() const { return parameters_.brake_fitted ? parameters_.brake_release : 0; }

  DriveSequenceParameters parameters_{};
  std::int32_t samples_ = 0;
};

}  // namespace firmware
