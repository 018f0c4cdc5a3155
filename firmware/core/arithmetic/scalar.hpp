// Requirements of the control core on its number type: float on a processor with FPU, fixed point elsewhere.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>

namespace firmware {

/// Fractional bits of reference positions and of their increments (see count_position.hpp).
inline constexpr int kFractionBits = 48;

/// Conversions between a scalar and integers. Each is a fixed sequence of operations, so that its result is the same to
/// the last bit on every machine. A fixed-point type specialises this template.
template <typename Scalar>
struct ScalarTraits;

template <std::floating_point Real>
struct ScalarTraits<Real> {
  static constexpr Real from_integer(std::int32_t value) { return static_cast<Real>(value); }

  /// number * factor.
  static constexpr Real times(std::int32_t number, Real factor) { return from_integer(number) * factor; }

  /// 1 / value, in a type whose range may differ from the scalar's.
  using Reciprocal = Real;
  static constexpr Reciprocal reciprocal(Real value) { return Real(1) / value; }

  /// value * rate as a whole number, halves away from zero. |value * rate| < 2^31.
  static constexpr std::int32_t nearest_product(Real value, Reciprocal rate) {
    constexpr Real kHalf = Real(0.5f);
    const Real product = value * rate;
    return truncate(product < Real(0) ? product - kHalf : product + kHalf);
  }

  static constexpr float to_float(Real value) { return static_cast<float>(value); }

  /// Toward zero. |value| < 2^31; outside that range results differ between machines, so callers limit first.
  static constexpr std::int32_t truncate(Real value) { return static_cast<std::int32_t>(value); }

  static constexpr bool is_nan(Real value) { return !(value == value); }
  static constexpr Real magnitude(Real value) {
    if constexpr (sizeof(Real) == sizeof(float))
      return __builtin_fabsf(value);
    else
      return __builtin_fabs(value);
  }
  static constexpr bool is_finite(Real value) { return !is_nan(value * Real(0)); }

  /// value * 2^-exponent, 0 <= exponent < 127.
  static constexpr Real scale_down(Real value, std::int32_t exponent) {
    return value * static_cast<Real>(std::bit_cast<float>(static_cast<std::uint32_t>(127 - exponent) << 23));
  }

  /// An increment, counts * 2^48, as counts. |increment| < 2^63. Both halves are converted on their own because a
  /// 64-bit conversion is a library call on a 32-bit processor.
  static constexpr Real from_increment(std::int64_t increment) {
    constexpr Real kHighUnit = Real(1) / Real(std::int64_t{1} << (kFractionBits - 32));
    constexpr Real kLowUnit = Real(1) / Real(std::int64_t{1} << kFractionBits);
    const auto high = static_cast<std::int32_t>(increment >> 32);
    const auto low = static_cast<std::uint32_t>(increment);
    return static_cast<Real>(high) * kHighUnit + static_cast<Real>(low) * kLowUnit;
  }

  /// A position's fraction of a count, 0 <= fraction < 2^48, as counts; bits below 2^-31 counts are dropped.
  static constexpr Real from_fraction(std::int64_t fraction) {
    constexpr Real kUnit = Real(1) / Real(std::int64_t{1} << 31);
    return static_cast<Real>(static_cast<std::int32_t>(fraction >> (kFractionBits - 31))) * kUnit;
  }

  /// Counts as an increment, toward zero. |counts| < 2^15. In three exact pieces, because a conversion to 64 bits is a
  /// library call in double precision on a 32-bit processor.
  static constexpr std::int64_t to_increment(Real counts) {
    constexpr Real kPiece = Real(65536);
    const Real scaled = counts * kPiece;
    const std::int32_t high = truncate(scaled);
    const Real rest = (scaled - static_cast<Real>(high)) * kPiece;
    const std::int32_t middle = truncate(rest);
    const std::int32_t low = truncate((rest - static_cast<Real>(middle)) * kPiece);
    return (std::int64_t{high} * 65536 + middle) * 65536 + low;
  }
};

template <typename Scalar>
constexpr bool is_positive(Scalar value) {
  return value > Scalar(0) && ScalarTraits<Scalar>::is_finite(value);
}

}  // namespace firmware
