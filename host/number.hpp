// Numbers in text files.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace host {

inline std::string_view trim_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Parses all of `text`, except surrounding blanks, as a number with a decimal point; empty if it is not a number or
/// exceeds the range of double. Accepts "nan" and "inf": callers check std::isfinite.
inline std::optional<double> parse_number(std::string_view text) {
  text = trim_blanks(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

struct NamedNumber {
  std::string name;
  double value;
};

/// Parses NAME=NUMBER of an option; empty unless the number is finite and above 0.
std::optional<NamedNumber> parse_named_number(std::string_view text);

/// The weight of the last digit of a number in text: 0.001 for "12.500", 10 for "3e1".
double last_digit_of(std::string_view number);

}  // namespace host
