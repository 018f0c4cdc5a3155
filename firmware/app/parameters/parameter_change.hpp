// Consequences of a change from one set of parameters to another.
#pragma once

#include <bit>
#include <cstdint>

#include "firmware/app/parameters/parameter_values.hpp"

namespace firmware {

/// For sets of equal size: index of the first changed value that must not change while an axis is enabled; size() if
/// there is none.
constexpr std::size_t change_that_needs_standstill(const ParameterValues& from, const ParameterValues& to) {
  for (std::size_t place = 0; place < from.size(); ++place) {
    const bool changed = std::bit_cast<std::uint32_t>(from.at(place)) != std::bit_cast<std::uint32_t>(to.at(place));
    if (changed && rule_at(place).change == ParameterChange::while_disabled) return place;
  }
  return from.size();
}

/// Whether the change invalidates the home position.
constexpr bool do_counts_change_meaning(const AxisValues& from, const AxisValues& to) {
  return from.get<"drive.encoder_resolution">() != to.get<"drive.encoder_resolution">() ||
         from.get<"homing.mode">() != to.get<"homing.mode">() ||
         from.get<"homing.velocity">() != to.get<"homing.velocity">() ||
         from.get<"homing.position">() != to.get<"homing.position">();
}

}  // namespace firmware
