// Checks whether a whole set of values may be taken over: each in its range, and all consistent.
#pragma once

#include "firmware/app/parameters/axis_values.hpp"
#include "firmware/core/axis_check.hpp"
#include "firmware/core/supervision/supervised_check.hpp"

namespace firmware {

struct SetRefusal {
  ValueRefusal kind = ValueRefusal::none;
  ParameterKey key{};
  Refusal core = Refusal::none;  ///< the core's own, for refused_by_core
  constexpr bool operator==(const SetRefusal& other) const { return kind == other.kind && key == other.key; }
};

namespace parameter_check {

template <parameter_rows::Name name>
constexpr std::uint16_t id_of() {
  return parameter_rows::kRules[parameter_rows::row_named<name>()].id;
}

/// The parameter to which the control core's refusal refers.
constexpr std::uint16_t id_behind(Refusal refusal) {
  const std::uint16_t id = parameter_behind(refusal);
  return id != 0 ? id : id_of<"drive.sample_period">();
}

/// Rounding of 1 / rate to single precision, and of a period written with seven digits.
inline constexpr float kPeriodTolerance = 1e-5F;

template <typename Scalar>
constexpr SetRefusal check_axis(const ParameterValues& values, std::size_t axis) {
  const AxisValues v = values.axis(axis);
  const bool is_fitted = v.get<"drive.fitted">();
  if (!is_fitted) return {};
  const float periods = v.get<"drive.sample_period">() * static_cast<float>(values.get<"control.rate">());
  if (periods < 1.0F - kPeriodTolerance || periods > 1.0F + kPeriodTolerance)
    return {ValueRefusal::rate_disagrees, ParameterKey::of_axis(axis, id_of<"drive.sample_period">())};
  const AxisParameters<Scalar> parameters = axis_parameters<Scalar>(v);
  const Refusal error = check_supervised(parameters);
  if (error == Refusal::none) return {};
  return {ValueRefusal::refused_by_core, ParameterKey::of_axis(axis, id_behind(error)), error};
}

}  // namespace parameter_check

/// The first problem of a set for a board that computes in `Scalar`. The values of an axis that is not fitted need not
/// be consistent, but each must be in its range.
template <typename Scalar>
constexpr SetRefusal check(const ParameterValues& values) {
  for (std::size_t place = 0; place < values.size(); ++place) {
    const ValueRefusal problem = check_value(rule_at(place), values.at(place));
    if (problem != ValueRefusal::none) return {static_cast<ValueRefusal>(problem), key_at(place)};
  }
  for (std::size_t axis = 0; axis < values.axes(); ++axis) {
    const SetRefusal problem = parameter_check::check_axis<Scalar>(values, axis);
    if (problem.kind != ValueRefusal::none) return problem;
  }
  return {};
}

}  // namespace firmware
