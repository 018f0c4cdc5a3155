// exp(-y) without the C library, whose results differ between newlib, picolibc and glibc.
#pragma once

#include <cstdint>

#include "firmware/core/arithmetic/scalar.hpp"

namespace firmware {

/// exp(-y) for y >= 0; for negative y it is 1. exp(0) is exactly 1; from y = 87 on (exp(-87) = 1.6e-38) it is 0. In
/// float the relative error is below 7.5e-8 * (3 + y): the roundings of y*log2(e) (6e-8 y) and of log2(e) itself
/// (1.3e-8 y), and three more of the polynomial's result.
///
/// exp(-y) = 2^-n * 2^-f with n + f = y*log2(e), |f| <= 1/2. The polynomial is the minimax fit of degree 6 to 2^-f in
/// relative error (Remez exchange, 50 digits; error 1.9e-9), with its constant 1.00000000055 rounded to 1.
template <typename Scalar>
constexpr Scalar exp_negative(Scalar y) {
  using Traits = ScalarTraits<Scalar>;
  if (!(y > Scalar(0))) return Scalar(1);
  if (y >= Scalar(87)) return Scalar(0);
  const Scalar binary_exponent = y * Scalar(1.44269504f);  // log2(e)
  const std::int32_t n = Traits::truncate(binary_exponent + Scalar(0.5f));
  const Scalar f = binary_exponent - Traits::from_integer(n);
  Scalar power = Scalar(0.000153458122f);
  power = power * f + Scalar(-0.00133999312f);
  power = power * f + Scalar(0.00961848896f);
  power = power * f + Scalar(-0.0555032878f);
  power = power * f + Scalar(0.240226469f);
  power = power * f + Scalar(-0.693147206f);
  power = power * f + Scalar(1);
  return Traits::scale_down(power, n);
}

}  // namespace firmware
