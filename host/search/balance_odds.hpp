// What the odds of the force balance leave to the search in the motion.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/effort/effort_screen.hpp"
#include "sim/effect.hpp"

namespace host {

/// The kinds of which the force balance holds one to be present beside `kinds` with a probability of at least kClaimed,
/// most probable first. Empty if it did not try any, or if no such group exists.
std::vector<std::string> probable_kinds(const EffortScreen& balance, const std::vector<std::string>& kinds);

/// Whether the balance tried both effects beside `kinds` and holds `other` to be impossible beside the leader.
bool are_told_apart(const EffortScreen& balance, const std::vector<std::string>& kinds, std::string_view leader,
                    std::string_view other);

/// Whether the force balance found a second mass more probable than no further effect beside `kinds`; or beside the
/// base, if it has no odds of a second mass beside `kinds`. True if it has none there either.
bool allows_second_mass(const EffortScreen& balance, const std::vector<std::string>& kinds);

/// The model of the force balance with `kinds` and this effect as the last one; empty if it did not try them. Its base
/// has not taken over the part of the effect, as one may that was fitted to the motion without it.
std::optional<sim::DriveDescription> balanced_start(const EffortScreen& balance, std::vector<std::string> kinds,
                                                    const sim::EffectInfo& info);

}  // namespace host
