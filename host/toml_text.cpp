#include "host/toml_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/exit_codes.hpp"

namespace host {

namespace {

constexpr int kMostDots = 16;

/// The end of the string that begins with the quote at `begin`: after its last quote, or at the end of the text.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string_view three = quote == '"' ? "\"\"\"" : "'''";
  const bool long_string = text.substr(begin, 3) == three;
  for (std::size_t k = begin + (long_string ? 3 : 1); k < text.size(); ++k) {
    if (quote == '"' && text[k] == '\\')
      ++k;
    else if (long_string ? text.substr(k, 3) == three : text[k] == quote)
      return k + (long_string ? 3 : 1);
    else if (!long_string && text[k] == '\n')
      return k;
  }
  return text.size();
}

void refuse_deep_keys(std::string_view text, std::string_view name) {
  std::size_t line = 1;
  int dots = 0;
  for (std::size_t k = 0; k < text.size();) {
    std::size_t next = k + 1;
    const char c = text[k];
    if (c == '"' || c == '\'') {
      next = end_of_string(text, k);
    } else if (c == '#') {
      next = std::min(text.find('\n', k), text.size());
    } else if (std::string_view(",=[]{}\n").find(c) != std::string_view::npos) {
      dots = 0;
    } else if (c == '.' && ++dots > kMostDots) {
      throw Failure(
          ExitCode::bad_input,
          fmt::format("{}: line {}: a key of more than {} parts; write tables and keys as the format has them", name,
                      line, kMostDots));
    }
    for (; k < next && k < text.size(); ++k) line += text[k] == '\n' ? 1 : 0;
    k = next;
  }
}

}  // namespace

toml::table parse_toml(std::string_view text, std::string_view name) {
  refuse_deep_keys(text, name);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: line {}: not valid TOML: {}; correct the line", name,
                                                   error.source().begin.line, error.description()));
  }
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + '"';
}

std::string toml_number(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace host
