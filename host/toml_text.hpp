// Checks and writes TOML for all readers of the tool.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace host {

/// Parses a file's text. Throws Failure(bad_input) naming `name`, line and remedy if it is not TOML, or if a key has so
/// many parts (`a.b.c…`) that destroying the tree would exhaust the stack: no format here has more than four parts.
toml::table parse_toml(std::string_view text, std::string_view name);

/// A TOML string of any text: the basic one, with what it must escape.
std::string toml_string(std::string_view text);

}  // namespace host
