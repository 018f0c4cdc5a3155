// Formats text and numbers for HTML, JSON and terminals.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace host {

/// Escapes text for HTML elements and quoted attributes.
std::string escape_html(std::string_view text);

/// JSON that is safe in a <script> element: it contains no '<', so that user text cannot end an element or a comment.
/// Text that is not UTF-8 is shown with replacement characters.
std::string script_safe_json(const nlohmann::json& value);

/// The text with a capital first letter.
std::string capitalised(std::string text);

/// One word of a command line that can be pasted into a shell. It is quoted if it contains unusual characters.
std::string shell_word(std::string_view text);

/// A number for readers: `digits` significant digits, no exponent between 0.001 and 1 000 000; "–" if not finite.
std::string format_value(double value, int digits = 3);

/// `value` rounded to `digits` significant digits, so that its text is short.
double rounded_to_digits(double value, int digits);

/// A name with spaces instead of underscores: "travel since reversal".
std::string spaced(std::string name);

}  // namespace host
