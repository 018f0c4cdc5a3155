// Description of one parameter: identity, permitted values, meaning.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

namespace firmware {

enum class ParameterScope : std::uint8_t { board = 0, axis = 1 };

/// How the value is read. All are kept as single precision, which holds whole numbers up to 2^24 exactly.
enum class ParameterType : std::uint8_t { real = 0, whole = 1, toggle = 2 };

enum class ParameterChange : std::uint8_t { any_time = 0, while_disabled = 1 };

/// One row of the table (app/parameters/parameter_table.hpp).
struct ParameterInfo {
  std::uint16_t id;  ///< 1..4095, permanent: the id of a removed parameter is never reused
  ParameterScope scope;
  std::string_view name;  ///< "group.name", without the axis
  ParameterType type;
  std::string_view unit;         ///< "1" for a pure number, "" for a switch
  std::string_view linear_unit;  ///< of a linear drive, with travel in m and force in N
  float minimum, maximum, initial;
  ParameterChange change;
  std::string_view doc;  ///< one line
};

/// The part of a row that decides whether a value is accepted: all that the board needs.
struct ParameterRule {
  std::uint16_t id;
  ParameterType type;
  ParameterChange change;
  float minimum, maximum, initial;
};

/// Why a value, or a set of them, is refused. Numbers are permanent.
enum class ValueRefusal : std::uint8_t {
  none = 0,
  not_a_number = 1,
  below_minimum = 2,
  above_maximum = 3,
  not_whole = 4,
  rate_disagrees = 5,  ///< drive.sample_period is not 1 / control.rate
  refused_by_core = 6  ///< for a Refusal: the parameter contradicts others of its axis
};

constexpr ValueRefusal check_value(const ParameterRule& rule, float value) {
  // Checks the bits before any comparison, which an infinity or not-a-number must not reach.
  constexpr std::uint32_t kExponent = 0x7F800000;
  if ((std::bit_cast<std::uint32_t>(value) & kExponent) == kExponent) return ValueRefusal::not_a_number;
  if (value < rule.minimum) return ValueRefusal::below_minimum;
  if (value > rule.maximum) return ValueRefusal::above_maximum;
  if (rule.type == ParameterType::real) return ValueRefusal::none;
  return static_cast<float>(static_cast<std::int32_t>(value)) == value ? ValueRefusal::none : ValueRefusal::not_whole;
}

}  // namespace firmware
