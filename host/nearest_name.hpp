// Finds the known name closest to a mistyped one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace host {

/// The known name with the fewest typing errors, if these are at most a third of the letters; otherwise empty.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

/// "; did you mean X?" or "", to append to a message about an unknown name.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> known);

}  // namespace host
