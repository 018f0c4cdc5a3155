// Converts volts to D/A codes and gives the voltage of each code.
#pragma once

#include <cstdint>

#include "firmware/core/arithmetic/scalar.hpp"

namespace firmware {

template <typename Scalar>
struct DacWord {
  std::int32_t code = 0;
  Scalar volts{};  ///< output of the code: code * resolution
  bool saturated = false;
};

/// Rounds to the nearest code, halves away from zero. The range is symmetric, -max_code..max_code, with
/// max_code * resolution strictly below the limit: a two's complement converter lacks the code for +limit, and an
/// unequal range would bias a saturated loop.
template <typename Scalar>
class DacConversion {
 public:
  /// `resolution_V` > 0, `limit_V` >= 2 * resolution_V, and their quotient < 2^24.
  constexpr void configure(Scalar resolution_V, Scalar limit_V) {
    resolution_V_ = resolution_V;
    codes_per_volt_ = Traits::reciprocal(resolution_V);
    max_code_ = Traits::nearest_product(limit_V, codes_per_volt_) - 1;
    limit_V_ = Traits::times(max_code_, resolution_V);
  }

  /// `volts` is a number; the caller has excluded not-a-number.
  constexpr DacWord<Scalar> operator()(Scalar volts) const {
    if (!is_within(volts))
      return volts > Scalar(0) ? DacWord<Scalar>{.code = max_code_, .volts = limit_V_, .saturated = true}
                               : DacWord<Scalar>{.code = -max_code_, .volts = Scalar(0) - limit_V_, .saturated = true};
    const std::int32_t code = Traits::nearest_product(volts, codes_per_volt_);
    return {.code = code, .volts = Traits::times(code, resolution_V_)};
  }

  /// False for NaN as well.
  constexpr bool is_within(Scalar volts) const { return Traits::magnitude(volts) <= limit_V_; }

  constexpr std::int32_t max_code() const { return max_code_; }

 private:
  using Traits = ScalarTraits<Scalar>;

  Scalar resolution_V_{};
  typename Traits::Reciprocal codes_per_volt_{};
  Scalar limit_V_{};
  std::int32_t max_code_ = 0;
};

}  // namespace firmware
