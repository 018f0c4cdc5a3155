#include "sim/drive_description.hpp"

#include <algorithm>

namespace sim {

const EffectEntry* DriveDescription::find(std::string_view kind) const {
  const auto found = std::ranges::find(effects, kind, &EffectEntry::kind);
  return found == effects.end() ? nullptr : &*found;
}

EffectEntry* DriveDescription::find(std::string_view kind) {
  const auto found = std::ranges::find(effects, kind, &EffectEntry::kind);
  return found == effects.end() ? nullptr : &*found;
}

}  // namespace sim
