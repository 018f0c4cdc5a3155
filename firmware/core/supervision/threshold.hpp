// A monitor's threshold: its parameter, and the units in which it is given, stored and computed.
#pragma once

#include <cstdint>
#include <string_view>
#include <type_traits>

#include "firmware/core/arithmetic/fixed_point.hpp"
#include "firmware/core/parameter_info.hpp"

namespace firmware {

/// Kind of threshold, which determines the units of the parameter and of its field.
enum class Quantity : std::uint8_t {
  length,               ///< mm (m)
  velocity,             ///< of the drive, rad/s (m/s)
  length_per_velocity,  ///< mm s/rad (s)
  command,              ///< V
  share,                ///< 1
  time,                 ///< s; kept in samples
  travel,               ///< mm (m); kept in counts
  counts,               ///< of the encoder
};

/// The parameter's row. Every threshold belongs to one axis and changes while the axis is disabled.
struct ThresholdRow {
  std::uint16_t id = 0;  ///< never used before (app/parameters/parameter_table.hpp)
  std::string_view name;
  Quantity quantity = Quantity::share;
  float minimum = 0, maximum = 0, initial = 0;
  std::string_view doc;

  constexpr ParameterInfo parameter() const {
    struct Units {
      std::string_view rotary, linear;
    };
    constexpr Units kUnits[] = {{"mm", "m"}, {"rad/s", "m/s"}, {"mm/(rad/s)", "m/(m/s)"},
                                {"V", "V"},  {"1", "1"},       {"s", "s"},
                                {"mm", "m"}, {"", ""}};
    const Units& units = kUnits[static_cast<std::size_t>(quantity)];
    return {.id = id,
            .scope = ParameterScope::axis,
            .name = name,
            .type = quantity == Quantity::counts ? ParameterType::whole : ParameterType::real,
            .unit = units.rotary,
            .linear_unit = units.linear,
            .minimum = minimum,
            .maximum = maximum,
            .initial = initial,
            .change = ParameterChange::while_disabled,
            .doc = doc};
  }
};

/// `Field`: pointer to the member of a monitor's limits that the parameter sets.
template <typename Field>
struct Threshold {
  Field field;
  ThresholdRow row;
};

template <typename Field>
constexpr Threshold<Field> threshold(Field field, const ThresholdRow& row) {
  return {field, row};
}

/// Travel as encoder counts, limited to 32 bits.
constexpr std::int64_t whole_counts(float travel, float encoder_resolution) {
  constexpr float kMost = 2147483520.0F;  // the largest float below 2^31
  const float counts = travel / encoder_resolution;
  return static_cast<std::int32_t>(counts > kMost ? kMost : (counts < -kMost ? -kMost : counts));
}

namespace threshold_units {

/// A parameter's value as its field stores it.
template <typename Kept>
constexpr Kept kept(float value, Quantity quantity, float encoder_resolution, float samples_a_second) {
  if constexpr (std::is_integral_v<Kept>) {
    if (quantity == Quantity::travel) return static_cast<Kept>(whole_counts(value, encoder_resolution));
    return quantity == Quantity::time ? ScalarTraits<float>::nearest_product(value, samples_a_second)
                                      : static_cast<Kept>(value);
  } else {
    return static_cast<Kept>(value);
  }
}

/// A field in fixed-point units (core/fixed_units.hpp); whole numbers are unchanged.
template <typename Kept, typename Units>
constexpr auto fixed(Kept value, Quantity quantity, const Units& unit) {
  if constexpr (std::is_integral_v<Kept>) {
    return value;
  } else {
    switch (quantity) {
      case Quantity::length:
        return FixedPoint::from(value / unit.length);
      case Quantity::velocity:
        return FixedPoint::from(value / unit.velocity);
      case Quantity::length_per_velocity:
        return FixedPoint::from(value * unit.velocity / unit.length);
      case Quantity::command:
        return FixedPoint::from(value / unit.volts);
      default:
        return FixedPoint::from(value);
    }
  }
}

}  // namespace threshold_units

}  // namespace firmware
