// Which known name a mistyped one may have meant.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace host {

/// The known name with the fewest typing errors, when they are few enough to be a mistake (a third of the letters);
/// empty otherwise.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

/// "; did you mean X?" or "" — to be put behind a message about an unknown name.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> known);

}  // namespace host
