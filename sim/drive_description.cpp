#include "sim/drive_description.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace sim {

std::optional<double> number_of(std::string_view id) {
  const std::size_t dash = id.rfind('_');
  if (dash == std::string_view::npos) return {};
  double number = 0.0;
  const char* const end = id.data() + id.size();
  const auto [rest, error] = std::from_chars(id.data() + dash + 1, end, number);
  if (error != std::errc{} || rest != end) return {};
  return number;
}

std::string_view family_of(std::string_view id) { return number_of(id) ? id.substr(0, id.rfind('_')) : id; }

std::string numbered_id(std::string_view family, double number) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), number);
  return std::string(family) + "_" + std::string(text.data(), end);
}

bool EffectEntry::has_any(std::string_view family) const {
  return std::ranges::any_of(parameters, [&](const auto& parameter) {
    return parameter.first == family || family_of(parameter.first) == family;
  });
}

const EffectEntry* DriveDescription::find(std::string_view kind) const {
  const auto found = std::ranges::find(effects, kind, &EffectEntry::kind);
  return found == effects.end() ? nullptr : &*found;
}

EffectEntry* DriveDescription::find(std::string_view kind) {
  const auto found = std::ranges::find(effects, kind, &EffectEntry::kind);
  return found == effects.end() ? nullptr : &*found;
}

}  // namespace sim
