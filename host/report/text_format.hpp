// Formats text and numbers for HTML, JSON and terminals.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace host {

/// Safe inside HTML elements and quoted attributes.
std::string escape_html(std::string_view text);

/// JSON that is safe inside a <script> element: it holds no '<', so user text can end neither element nor comment.
/// Text that is not UTF-8 is shown with replacement characters.
std::string script_safe_json(const nlohmann::json& value);

/// With a capital letter at its beginning.
std::string capitalised(std::string text);

/// One word of a command line that a reader may paste into a shell: quoted where it holds anything unusual.
std::string shell_word(std::string_view text);

/// A number for people: `digits` significant digits, no exponent between 0.001 and 1 000 000; "–" when not finite.
std::string format_value(double value, int digits = 3);

/// `value` rounded to `digits` significant digits, so that it prints shortly.
double rounded_to_digits(double value, int digits);

/// A name with spaces for underscores: "travel since reversal".
std::string spaced(std::string name);

}  // namespace host
