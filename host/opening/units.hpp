// Units as loggers write them in several languages.
#pragma once

#include <optional>
#include <string_view>

namespace host {

enum class Dimension {
  time,           ///< s
  angle,          ///< rad
  length,         ///< mm
  counts,         ///< 1
  angular_speed,  ///< rad/s
  linear_speed,   ///< mm/s
  count_speed,    ///< 1/s
  acceleration,   ///< any unit
  current,        ///< A
  torque,         ///< Nm
  force,          ///< N
  voltage,        ///< V
  temperature,    ///< deg C
  share,          ///< 1; relative to a rated value that the log does not give
};

/// value in the unit of the dimension = factor * number + offset.
struct UnitMeaning {
  Dimension dimension;
  double factor = 1.0;
  double offset = 0.0;
};

/// Meaning of "mm", "°", "U/min", "мс", "r.p.m.", "rad_s", "1/min" …; empty for an unknown unit.
std::optional<UnitMeaning> unit_named(std::string_view text);

/// The unit that is used for a dimension, "rad/s".
std::string_view unit_of(Dimension dimension);

}  // namespace host
