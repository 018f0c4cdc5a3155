// Fixed point for processors without FPU: 32 bits, 21 of them fraction, saturating.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "firmware/core/arithmetic/scalar.hpp"

namespace firmware {

/// raw / 2^fraction_bits. Sums, differences, products and quotients round to nearest (quotients toward zero) and
/// saturate instead of wrapping: a control signal far out of range has the same effect as one at its limit.
/// Constructors take constants; parameters are converted by from().
template <int fraction_bits>
class Fixed {
 public:
  constexpr Fixed() = default;
  explicit constexpr Fixed(int value) : raw_(saturate(std::int64_t{value} << fraction_bits)) {}
  explicit constexpr Fixed(float value) : Fixed(from(value)) {}

  static constexpr Fixed from_raw(std::int32_t raw) {
    Fixed result;
    result.raw_ = raw;
    return result;
  }

  /// Nearest value, or the nearest limit; not-a-number becomes 0.
  template <typename Real>
  static constexpr Fixed from(Real value) {
    constexpr Real kOne = static_cast<Real>(std::int64_t{1} << fraction_bits);
    constexpr Real kLimit = static_cast<Real>(std::int64_t{1} << (31 - fraction_bits));
    if (!(value < kLimit)) return from_raw(value >= kLimit ? kMost : 0);
    if (value <= -kLimit) return from_raw(kLeast);
    const Real scaled = value * kOne;
    constexpr Real kHalf = static_cast<Real>(0.5f);
    // A float this large has no fraction to round up; converting it to 64 bits would be a library call in double.
    using Whole = std::conditional_t<sizeof(Real) == sizeof(float), std::int32_t, std::int64_t>;
    return from_raw(saturate(static_cast<Whole>(scaled < Real(0) ? scaled - kHalf : scaled + kHalf)));
  }

  constexpr std::int32_t raw() const { return raw_; }

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 sees a null pointer in the default
  constexpr auto operator<=>(const Fixed&) const = default;

  friend constexpr Fixed operator+(Fixed a, Fixed b) { return from_raw(saturating_sum(a.raw_, b.raw_)); }
  friend constexpr Fixed operator-(Fixed a, Fixed b) { return from_raw(saturating_difference(a.raw_, b.raw_)); }
  friend constexpr Fixed operator*(Fixed a, Fixed b) {
    return from_raw(shift_down<fraction_bits>(std::int64_t{a.raw_} * b.raw_));
  }
  /// Rounded towards zero. A divisor of 0 gives the limit on the dividend's side. Divides 64 bits: not for the control
  /// interrupt.
  friend constexpr Fixed operator/(Fixed a, Fixed b) {
    if (b.raw_ == 0) return from_raw(a.raw_ < 0 ? kLeast : kMost);
    return from_raw(saturate((std::int64_t{a.raw_} << fraction_bits) / b.raw_));
  }

  static constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  static constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();

  static constexpr std::int32_t saturate(std::int64_t value) {
    const auto narrow = static_cast<std::int32_t>(value);
    return narrow == value ? narrow : (value < 0 ? kLeast : kMost);
  }

  /// value / 2^bits, to nearest, saturated; |value| <= 2^62.
  template <int bits>
  static constexpr std::int32_t shift_down(std::int64_t value) {
    return saturate((value + (std::int64_t{1} << (bits - 1))) >> bits);
  }

 private:
  static constexpr std::int32_t saturating_sum(std::int32_t a, std::int32_t b) {
    std::int32_t sum = 0;
    if (__builtin_add_overflow(a, b, &sum)) return a < 0 ? kLeast : kMost;
    return sum;
  }
  static constexpr std::int32_t saturating_difference(std::int32_t a, std::int32_t b) {
    std::int32_t difference = 0;
    if (__builtin_sub_overflow(a, b, &difference)) return a < 0 ? kLeast : kMost;
    return difference;
  }

  std::int32_t raw_ = 0;
};

/// The control core's scalar without FPU: -1024..1024 in steps of 4.8e-7. Ranges and units: fixed_units.hpp.
using FixedPoint = Fixed<21>;

template <int fraction_bits>
struct ScalarTraits<Fixed<fraction_bits>> {
  using Scalar = Fixed<fraction_bits>;

  static constexpr Scalar from_integer(std::int32_t value) {
    return Scalar::from_raw(Scalar::saturate(std::int64_t{value} << fraction_bits));
  }

  /// Product of a whole number and a scalar; the number need not fit the scalar's range.
  static constexpr Scalar times(std::int32_t number, Scalar factor) {
    return Scalar::from_raw(Scalar::saturate(std::int64_t{number} * factor.raw()));
  }

  /// 1 / value with 12 fractional bits, so that it may reach 2^19.
  using Reciprocal = Fixed<12>;
  static constexpr Reciprocal reciprocal(Scalar value) {
    if (value.raw() <= 0) return Reciprocal::from_raw(Reciprocal::kMost);
    constexpr std::int64_t kOne = std::int64_t{1} << (fraction_bits + 12);
    return Reciprocal::from_raw(Reciprocal::saturate((kOne + value.raw() / 2) / value.raw()));
  }

  /// value * rate as a whole number, halves away from zero.
  static constexpr std::int32_t nearest_product(Scalar value, Reciprocal rate) {
    constexpr int kShift = fraction_bits + 12;
    const std::int64_t product = std::int64_t{value.raw()} * rate.raw();
    const std::int64_t magnitude = ((product < 0 ? -product : product) + (std::int64_t{1} << (kShift - 1))) >> kShift;
    return static_cast<std::int32_t>(product < 0 ? -magnitude : magnitude);
  }

  static constexpr float to_float(Scalar value) {
    return static_cast<float>(value.raw()) / static_cast<float>(std::int32_t{1} << fraction_bits);
  }

  static constexpr std::int32_t truncate(Scalar value) { return value.raw() / (std::int32_t{1} << fraction_bits); }

  static constexpr bool is_nan(Scalar) { return false; }
  static constexpr Scalar magnitude(Scalar value) { return value.raw() < 0 ? Scalar{} - value : value; }

  /// A value at a limit of the range counts as out of range.
  static constexpr bool is_finite(Scalar value) {
    return value.raw() != Scalar::kMost && value.raw() != Scalar::kLeast;
  }

  static constexpr Scalar scale_down(Scalar value, std::int32_t exponent) {
    return exponent > 30 ? Scalar{} : Scalar::from_raw(value.raw() >> exponent);
  }

  static constexpr Scalar from_increment(std::int64_t increment) {
    constexpr int kShift = kFractionBits - fraction_bits;
    return Scalar::from_raw(Scalar::saturate((increment + (std::int64_t{1} << (kShift - 1))) >> kShift));
  }

  static constexpr Scalar from_fraction(std::int64_t fraction) { return from_increment(fraction); }

  static constexpr std::int64_t to_increment(Scalar counts) {
    return std::int64_t{counts.raw()} << (kFractionBits - fraction_bits);
  }
};

}  // namespace firmware
