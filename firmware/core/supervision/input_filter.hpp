// Filters contact bounce and noise spikes: an input counts once it has been active for a while.
#pragma once

#include <cstdint>

#include "firmware/core/arithmetic/scalar.hpp"

namespace firmware {

/// Longer than noise spikes and the bounce of a closing contact; at 250 mm/s it is half a millimetre.
inline constexpr float kInputTime_s = 0.002f;

/// Successive control periods in which an input must be active: at least two, so that no single reading stops an axis.
template <typename Real>
constexpr std::int32_t input_samples(Real sample_period_s) {
  const std::int32_t samples = ScalarTraits<Real>::truncate(Real(kInputTime_s) / sample_period_s + Real(0.01f)) + 1;
  return samples > 2 ? samples : 2;
}

class InputFilter {
 public:
  /// An active input stays active: a change of parameters does not hide it.
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
