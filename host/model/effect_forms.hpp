// Effects whose parameters may be given per direction, or once for both directions.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "sim/effect.hpp"

namespace host {

/// The ids that a common parameter for both directions sets ("positive negative" -> two ids).
std::vector<std::string_view> ids_of_pair(const sim::ParameterInfo& both);

/// Whether a drive may have several effects of this kind, each with its own period or time.
bool may_repeat(const sim::EffectInfo& info);

/// Key of the standard deviations of a free curve's values, one per value.
constexpr std::string_view curve_deviation_key(sim::DriveKind kind) {
  return kind == sim::DriveKind::rotary ? "sd_Nm" : "sd_N";
}

/// All kinds of the catalogue, for messages.
std::vector<std::string_view> effect_kinds();

/// Throws Failure(usage), with the most similar kind, if the catalogue has no kind of this name.
const sim::EffectInfo& known_effect(std::string_view kind);

/// Whether an interval belongs to this value, that is, contains it within the rounding of its ends.
bool holds(const std::array<double, 2>& interval, double value);

}  // namespace host
