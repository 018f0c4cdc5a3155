// TOML as every reader of the tool takes it.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace host {

/// Parses a file's text. Throws Failure(bad_input) naming `name`, line and remedy where it is no TOML, or where a key
/// has so many parts (`a.b.c…`) that taking the tree apart again would exhaust the stack: no format here has more than
/// four.
toml::table parse_toml(std::string_view text, std::string_view name);

/// A TOML string of any text: the basic one, with what it must escape.
std::string toml_string(std::string_view text);

}  // namespace host
