// Contacts bounce and wires catch sparks: an input counts once it has been active for a while.
#pragma once

#include <cstdint>

#include "firmware/core/arithmetic/scalar.hpp"

namespace firmware {

/// A spark is shorter, and so is the bounce of a contact that closes; at 250 mm/s it is half a millimetre.
inline constexpr float kInputTime_s = 0.002f;

/// Control periods in a row that an input must be active in: two at least, so that no single reading trips an axis.
template <typename Real>
constexpr std::int32_t input_samples(Real sample_period_s) {
  const std::int32_t samples = ScalarTraits<Real>::truncate(Real(kInputTime_s) / sample_period_s + Real(0.01f)) + 1;
  return samples > 2 ? samples : 2;
}

class InputFilter {
 public:
  /// An input that is active stays so: no change of parameters hides it.
  constexpr void configure(std::int32_t samples) { samples_ = samples; }

  /// Once a control period, at least while the input is active or pending.
  constexpr bool filtered(bool is_active) {
    if (!is_active)
      active_samples_ = 0;
    else if (active_samples_ < samples_)
      ++active_samples_;
    return is_active && active_samples_ >= samples_;
  }

  /// It was active in the last control period.
  constexpr bool is_pending() const { return active_samples_ != 0; }

 private:
  std::int32_t samples_ = 2;
  std::int32_t active_samples_ = 0;
};

}  // namespace firmware
