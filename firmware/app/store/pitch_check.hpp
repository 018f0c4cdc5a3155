// Checks whether parameters fit the tables of pitch errors in the store.
#pragma once

#include <bit>

#include "firmware/app/parameters/parameter_check.hpp"

namespace firmware {

namespace pitch_check {

inline constexpr std::uint16_t kSwitch = parameter_check::id_of<"pitch.on">();

}  // namespace pitch_check

inline std::uint32_t resolution_bits(const ParameterValues& values, std::size_t axis) {
  return std::bit_cast<std::uint32_t>(values.axis(axis).get<"drive.encoder_resolution">());
}

/// A fitted axis whose pitch.on is set needs a table in counts of its encoder.
template <typename Store>
SetRefusal check_tables(const ParameterValues& values, const Store& store) {
  for (std::size_t axis = 0; axis < values.axes(); ++axis) {
    if (!values.axis(axis).get<"drive.fitted">() || !values.axis(axis).get<"pitch.on">()) continue;
    const auto table = store.table(axis);
    if (table.points.empty() || table.head.resolution_bits != resolution_bits(values, axis))
      return {ValueRefusal::refused_by_core, ParameterKey::of_axis(axis, pitch_check::kSwitch)};
  }
  return {};
}

}  // namespace firmware
