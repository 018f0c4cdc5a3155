// Parses TOML and writes TOML strings.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace host {

/// Parses a file's text. Throws Failure(bad_input) naming `name`, line and remedy if it is not TOML, or if a key has
/// too many parts (`a.b.c…`): no format here needs more than four, and destroying a very deep tree would exhaust the
/// stack.
toml::table parse_toml(std::string_view text, std::string_view name);

/// Any text as a basic TOML string, with the required escapes.
std::string toml_string(std::string_view text);

/// The shortest text that gives the same number when it is read, and that is a float in TOML.
std::string toml_number(double value);

}  // namespace host
