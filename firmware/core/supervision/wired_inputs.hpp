// Optional inputs: the amplifier's ready contact, the fault output of the encoder's receivers.
#pragma once

#include "firmware/core/axis_fault.hpp"
#include "firmware/core/axis_parameters.hpp"
#include "firmware/core/supervision/drive_sequence.hpp"
#include "firmware/core/supervision/input_filter.hpp"
#include "hal/encoder.hpp"

namespace firmware {

class WiredInputs {
 public:
  template <typename Scalar>
  constexpr void configure(const AxisParameters<Scalar>& p) {
    has_ready_ = p.sequence.ready_input;
    has_receivers_ = p.encoder_fault_input;
    has_any_ = has_ready_ || has_receivers_;
    unready_.configure(p.monitors.input_samples);
    broken_wire_.configure(p.monitors.input_samples);
  }

  /// Whether an input is wired. Otherwise watch() finds nothing. Called in every control period.
  constexpr bool has_any() const { return has_any_; }

  /// Once a control period. Readiness counts only with the loop closed.
  template <typename Hal>
  [[gnu::noinline]] constexpr AxisFault watch(Hal& hal, bool is_closed) {
    if (broken_wire_.filtered(says_broken(hal.encoder()))) return AxisFault::encoder_invalid;
    const bool is_unready = has_ready_ && is_closed && !is_ready(hal.drive_enable());
    return unready_.filtered(is_unready) ? AxisFault::amplifier_not_ready : AxisFault::none;
  }

  /// Not filtered: decides which sensor is faulty where two of them differ.
  template <hal::Encoder Encoder>
  constexpr bool says_broken(Encoder& encoder) const {
    if constexpr (hal::MonitoredEncoder<Encoder>) return has_receivers_ && encoder.is_faulted();
    return false;
  }

 private:
  bool has_any_ = false, has_ready_ = false, has_receivers_ = false;
  InputFilter unready_, broken_wire_;
};

}  // namespace firmware
