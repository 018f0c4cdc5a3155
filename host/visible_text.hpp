// Makes text from files safe to show on a terminal.
#pragma once

#include <string>
#include <string_view>

namespace host {

/// Printable ASCII stays; every other byte and the backslash are written as \xNN, so that no escape sequence, line feed
/// or direction mark hides a part of the text.
std::string visible_text(std::string_view text);

}  // namespace host
