// Monitors the whole board: stop circuit, supply, timing, host, parameter store.
#pragma once

#include <concepts>
#include <cstdint>

#include "firmware/core/arithmetic/scalar.hpp"
#include "firmware/core/axis_fault.hpp"
#include "firmware/core/supervision/input_filter.hpp"

namespace firmware {

/// Inputs at the beginning of a control period.
struct BoardInputs {
  std::uint32_t now_us = 0;  ///< of a hal::Clock
  bool emergency_stop = false;
  bool supply_low = false;
  bool store_damaged = false;
  bool settings_changed = false;  ///< in memory, without being set
};

struct BoardLimits {
  std::uint32_t control_period_us = 1000;
  std::uint32_t longest_period_us = 1500;  ///< from one control period to the next
  std::int32_t heartbeat_samples = 100;    ///< longest silence of a host that commands motion
  std::int32_t standing_samples = 60'000;  ///< longest silence while the enabled axes are at rest
  std::int32_t input_samples = 3;          ///< in which the stop circuit must be open
  std::int32_t stop_samples = 0;           ///< for which axes may slow down after it; 0: stop category 0
};

class BoardWatch {
 public:
  /// A control period that is half a period late is an overrun. After 0.1 s of silence the host is lost (ten of its 10
  /// ms cycles); after a minute it has left enabled axes unattended.
  static constexpr BoardLimits default_limits(float sample_period_s) {
    const auto period_us = static_cast<std::uint32_t>(ScalarTraits<float>::nearest_product(sample_period_s, 1e6f));
    const float rate_Hz = 1.0f / sample_period_s;
    return {.control_period_us = period_us,
            .longest_period_us = period_us + period_us / 2,
            .heartbeat_samples = ScalarTraits<float>::nearest_product(0.1f, rate_Hz),
            .standing_samples = ScalarTraits<float>::nearest_product(60.0f, rate_Hz),
            .input_samples = firmware::input_samples(sample_period_s)};
  }

  constexpr void configure(const BoardLimits& limits) {
    limits_ = limits;
    stop_.configure(limits.input_samples);
  }
  constexpr const BoardLimits& limits() const { return limits_; }

  /// The next control period may be late: the control interrupt was disabled on purpose.
  constexpr void excuse_pause() {
    is_primed_ = false;
    is_unusual_ = true;
  }

  /// The host begins to command motion, or ends it.
  constexpr void host_commands(bool commands) {
    host_commands_ = commands;
    silent_samples_ = 0;
  }
  constexpr void host_heard() { silent_samples_ = 0; }
  /// The axes are enabled again.
  constexpr void forget_left_alone() { was_left_alone_ = false; }
  /// While the axes are being stopped together because of the silence, the silence is not a fault.
  constexpr void excuse_silence(bool excused) { excuses_silence_ = excused; }
  /// is_stopped(): the stop circuit is open, or was open and its delay still runs. The other: the delay is over.
  constexpr bool is_stopped() const { return is_stopped_; }
  constexpr bool is_stop_due() const { return stop_left_ < 0; }
  /// The host commands motion and has been silent for too long, and the outputs are on.
  constexpr bool is_host_lost() const { return is_host_lost_; }
  /// Since the last forget_left_alone(), axes at rest were disabled because no command came.
  constexpr bool was_left_alone() const { return was_left_alone_; }

  /// The worst fault of this period. Silence matters only while `outputs_on()`, which is called only then: it is a
  /// fault if axes move; if they are at rest, it calls `disable()`.
  template <std::invocable OutputsOn, std::invocable Disable>
  constexpr AxisFault watch(const BoardInputs& inputs, OutputsOn outputs_on, Disable disable) {
    bool late = inputs.now_us - last_us_ > limits_.longest_period_us;
    last_us_ = inputs.now_us;
    if (inputs.emergency_stop || is_unusual_) {
      late = late && is_primed_;
      is_primed_ = true;
      if (watch_stop(inputs.emergency_stop, disable)) return AxisFault::emergency_stop;
    }
    if (inputs.supply_low) return AxisFault::supply_low;
    if (inputs.settings_changed) return AxisFault::settings_changed;
    if (late) return AxisFault::control_overrun;
    if (inputs.store_damaged) return AxisFault::parameter_store_damaged;
    if (silent_samples_ < (host_commands_ ? limits_.heartbeat_samples : limits_.standing_samples)) {
      ++silent_samples_;
    } else if (outputs_on()) {
      is_host_lost_ = host_commands_;
      if (host_commands_) return excuses_silence_ ? AxisFault::none : AxisFault::host_heartbeat_lost;
      was_left_alone_ = true;
      disable();
      return AxisFault::none;
    }
    is_host_lost_ = false;
    return AxisFault::none;
  }
  constexpr AxisFault watch(const BoardInputs& inputs, bool outputs_on) {
    return watch(
        inputs, [outputs_on] { return outputs_on; }, [] {});
  }

 private:
  /// Returns whether the enables must drop. Stop category 1: until the delay is over, the axes are disabled as by
  /// request, each along its ramp. A short press is also a stop.
  template <std::invocable Disable>
  [[gnu::noinline]] constexpr bool watch_stop(bool is_open_now, Disable disable) {
    const bool is_open = stop_.filtered(is_open_now);
    if (is_open && !is_stopped_) {
      is_stopped_ = true;
      stop_left_ = limits_.stop_samples;
    }
    bool is_due = false;
    if (is_stopped_ && stop_left_ > 0) {
      --stop_left_;
      disable();
    } else if (is_stopped_) {
      is_due = is_open || stop_left_ == 0;
      stop_left_ = -1;
      is_stopped_ = is_open;
    }
    is_unusual_ = is_stopped_ || stop_.is_pending();
    return is_due;
  }

  BoardLimits limits_{};
  InputFilter stop_;  ///< of the stop circuit
  std::int32_t stop_left_ = -1;
  bool is_stopped_ = false;
  bool is_unusual_ = true;  ///< is_stopped_ or about to be, or not is_primed_
  std::uint32_t last_us_ = 0;
  std::int32_t silent_samples_ = 0;
  bool host_commands_ = false;
  bool excuses_silence_ = false, is_host_lost_ = false, was_left_alone_ = false;
  bool is_primed_ = false;
};

}  // namespace firmware
