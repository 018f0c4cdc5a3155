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

/// Phases of the states starting and stopping (firmware/README.md has the diagram).
enum class DrivePhase : std::uint8_t {
  none,
  energising,  ///< enable on, loop open: until the amplifier is ready
  releasing,   ///< loop closed, brake released: until it is open
  braking,     ///< at rest, brake applied: until it holds; then the enable drops
};

enum class DriveStep : std::uint8_t {
  wait,
  close_loop,  ///< the amplifier is ready: close the loop and release the brake
  started,     ///< the axis may move
  late,        ///< the amplifier does not become ready
  held,        ///< held by the brake, if there is one: the enable may drop
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

  /// There is nothing to wait for: the loop closes in the control period of the enable.
  constexpr bool starts_at_once() const {
    return !parameters_.ready_input && parameters_.amplifier_wait == 0 && release_samples() == 0;
  }

  constexpr void begin_start() { enter(DrivePhase::energising); }
  /// Of an axis that has stopped; further calls do nothing.
  constexpr void begin_braking() {
    if (!is_braking()) enter(DrivePhase::braking);
  }
  constexpr void end() { phase_ = DrivePhase::none; }
  constexpr bool is_braking() const { return phase_ == DrivePhase::braking; }

  /// Once a control period while a phase is going on. `is_ready`: the amplifier's contact.
  constexpr DriveStep next(bool is_ready) {
    ++samples_;
    const bool waited = samples_ > parameters_.amplifier_wait;
    switch (phase_) {
      case DrivePhase::energising:
        if (!(parameters_.ready_input ? is_ready : waited)) return waited ? DriveStep::late : DriveStep::wait;
        enter(DrivePhase::releasing);
        return DriveStep::close_loop;
      case DrivePhase::releasing:
        return samples_ > release_samples() ? DriveStep::started : DriveStep::wait;
      case DrivePhase::braking:
        return !parameters_.brake_fitted || samples_ > parameters_.brake_application ? DriveStep::held
                                                                                     : DriveStep::wait;
      case DrivePhase::none:
        break;
    }
    return DriveStep::wait;
  }

  template <hal::DriveEnable Lines>
  constexpr void release_brake(Lines& lines, bool released) const {
    if constexpr (hal::BrakeOutput<Lines>) lines.release_brake(released && parameters_.brake_fitted);
  }

 private:
  constexpr void enter(DrivePhase phase) {
    phase_ = phase;
    samples_ = 0;
  }
  constexpr std::int32_t release_samples() const { return parameters_.brake_fitted ? parameters_.brake_release : 0; }

  DriveSequenceParameters parameters_{};
  DrivePhase phase_ = DrivePhase::none;
  std::int32_t samples_ = 0;  ///< since the phase began
};

}  // namespace firmware
