// The catalogue of physical effects of a drive.
#pragma once

#include <span>
#include <string_view>

#include "sim/effect.hpp"

namespace sim {

/// All effects: the base first, then in the order of the drive's signal path.
std::span<const EffectInfo* const> catalogue();

/// The effect of that kind, or nullptr.
const EffectInfo* find_effect(std::string_view kind);

}  // namespace sim
