// Whether a whole set of values may be taken over: each in its range, and all fitting each other.
#pragma once

#include "firmware/app/parameters/axis_values.hpp"
#include "firmware/core/axis_check.hpp"
#include "firmware/core/supervision/supervised_check.hpp"

namespace firmware {

/// What is wrong with a set. Numbers are permanent: the first five are those of ValueProblem.
enum class SetProblemKind : std::uint8_t {
  none = 0,
  not_a_number = 1,
  below_minimum = 2,
  above_maximum = 3,
  not_whole = 4,
  rate_disagrees = 5,  ///< drive.sample_period is not 1 / control.rate
  refused_by_core = 6  ///< check(AxisParameters): the key's parameter does not go with the others of its axis
};

struct SetProblem {
  SetProblemKind kind = SetProblemKind::none;
  ParameterKey key{};
  ParameterError refusal = ParameterError::none;  ///< the core's own, for refused_by_core
  constexpr bool operator==(const SetProblem& other) const { return kind == other.kind && key == other.key; }
};

namespace parameter_check {

template <parameter_rows::Name name>
constexpr std::uint16_t id_of() {
  return parameter_rows::kRules[parameter_rows::row_named<name>()].id;
}

/// The parameter that the control core's complaint is about.
constexpr std::uint16_t id_behind(ParameterError error) {
  switch (error) {
    case ParameterError::lead:
      return id_of<"drive.lead">();
    case ParameterError::encoder_resolution:
      return id_of<"drive.encoder_resolution">();
    case ParameterError::dac_resolution:
      return id_of<"drive.dac_resolution">();
    case ParameterError::dac_limit:
      return id_of<"drive.dac_limit">();
    case ParameterError::tachometer_gain:
      return id_of<"tachometer.gain">();
    case ParameterError::drive_model:
      return id_of<"model.a12">();
    case ParameterError::kalman_gain:
      return id_of<"kalman.k11">();
    case ParameterError::state_feedback:
      return id_of<"feedback.k1">();
    case ParameterError::friction_curve:
      return id_of<"friction.static_positive">();
    case ParameterError::friction_blend:
      return id_of<"friction.blend">();
    case ParameterError::velocity_limit:
      return id_of<"limits.velocity">();
    case ParameterError::acceleration_limit:
      return id_of<"limits.acceleration">();
    case ParameterError::jerk_limit:
    case ParameterError::jerk_time:
      return id_of<"limits.jerk">();
    case ParameterError::following_error:
      return id_of<"monitor.following_error">();
    case ParameterError::disagreement:
      return id_of<"monitor.disagreement">();
    case ParameterError::overspeed:
      return id_of<"monitor.overspeed">();
    case ParameterError::polarity_command:
      return id_of<"monitor.polarity_command">();
    case ParameterError::estimator_poles:
      return id_of<"kalman.k11">();
    case ParameterError::loop_poles:
      return id_of<"feedback.k1">();
    case ParameterError::oscillation:
      return id_of<"monitor.oscillation">();
    case ParameterError::travel:
      return id_of<"monitor.travel_max">();
    case ParameterError::saturation_time:
      return id_of<"monitor.saturation_time">();
    case ParameterError::cogging:
      return id_of<"cogging.period_1">();
    case ParameterError::position_friction:
      return id_of<"position_friction.period">();
    case ParameterError::presliding:
      return id_of<"presliding.stiffness">();
    case ParameterError::backlash:
      return id_of<"backlash.gap">();
    case ParameterError::backlash_crossing:
      return id_of<"backlash.crossing_time">();
    case ParameterError::homing:
      return id_of<"homing.velocity">();
    case ParameterError::amplifier_ready:
      return id_of<"amplifier.ready_time">();
    case ParameterError::index_spacing:
      return id_of<"encoder.index_spacing">();
    case ParameterError::filters:
      return id_of<"notch.frequency">();
    case ParameterError::none:
    case ParameterError::sample_period:
    case ParameterError::controller_is_enabled:
      break;
  }
  return id_of<"drive.sample_period">();
}

/// Rounding of 1 / rate to single precision, and of a period written with seven digits.
inline constexpr float kPeriodTolerance = 1e-5F;

template <typename Scalar>
constexpr SetProblem check_axis(const ParameterValues& values, std::size_t axis) {
  const AxisValues v = values.axis(axis);
  const bool is_fitted = v.get<"drive.fitted">();
  if (!is_fitted) return {};
  const float periods = v.get<"drive.sample_period">() * static_cast<float>(values.get<"control.rate">());
  if (periods < 1.0F - kPeriodTolerance || periods > 1.0F + kPeriodTolerance)
    return {SetProblemKind::rate_disagrees, ParameterKey::of_axis(axis, id_of<"drive.sample_period">())};
  const AxisParameters<Scalar> parameters = axis_parameters<Scalar>(v);
  const ParameterError error = check_supervised(parameters);
  if (error == ParameterError::none) return {};
  return {SetProblemKind::refused_by_core, ParameterKey::of_axis(axis, id_behind(error)), error};
}

}  // namespace parameter_check

/// The first problem of a set for a board that computes in `Scalar`. An axis that is not fitted needs no sense in its
/// values, but each must be in its range.
template <typename Scalar>
constexpr SetProblem check(const ParameterValues& values) {
  for (std::size_t place = 0; place < values.size(); ++place) {
    const ValueProblem problem = check_value(rule_at(place), values.at(place));
    if (problem != ValueProblem::none) return {static_cast<SetProblemKind>(problem), key_at(place)};
  }
  for (std::size_t axis = 0; axis < values.axes(); ++axis) {
    const SetProblem problem = parameter_check::check_axis<Scalar>(values, axis);
    if (problem.kind != SetProblemKind::none) return problem;
  }
  return {};
}

}  // namespace firmware
