#include "host/record/text_encoding.hpp"

#include <cstdint>

namespace host {

namespace {

void append_utf8(std::uint32_t character, std::string& out) {
  const auto put = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (character < 0x80U) {
    put(character);
  } else if (character < 0x800U) {
    put(0xC0U | (character >> 6U));
    put(0x80U | (character & 0x3FU));
  } else if (character < 0x10000U) {
    put(0xE0U | (character >> 12U));
    put(0x80U | ((character >> 6U) & 0x3FU));
    put(0x80U | (character & 0x3FU));
  } else {
    put(0xF0U | (character >> 18U));
    put(0x80U | ((character >> 12U) & 0x3FU));
    put(0x80U | ((character >> 6U) & 0x3FU));
    put(0x80U | (character & 0x3FU));
  }
}

/// Pairs of bytes from `begin` on; the first of a pair is the high one where `big_end_first`.
std::string from_utf16(const std::string& text, std::size_t begin, bool big_end_first) {
  std::string out;
  out.reserve(text.size() / 2);
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<std::uint8_t>(text[at]), second = static_cast<std::uint8_t>(text[at + 1]);
    return big_end_first ? (std::uint32_t{first} << 8U) | second : (std::uint32_t{second} << 8U) | first;
  };
  for (std::size_t at = begin; at + 1 < text.size(); at += 2) {
    std::uint32_t character = unit(at);
    const bool is_first_half = character >= 0xD800U && character < 0xDC00U;
    if (is_first_half && at + 3 < text.size() && unit(at + 2) >= 0xDC00U && unit(at + 2) < 0xE000U) {
      character = 0x10000U + ((character - 0xD800U) << 10U) + (unit(at + 2) - 0xDC00U);
      at += 2;
    }
    append_utf8(character, out);
  }
  return out;
}

}  // namespace

std::string as_utf8(std::string text) {
  if (text.starts_with("\xEF\xBB\xBF")) return text.substr(3);
  if (text.starts_with("\xFF\xFE")) return from_utf16(text, 2, false);
  if (text.starts_with("\xFE\xFF")) return from_utf16(text, 2, true);
  if (text.size() >= 4 && text[1] == '\0' && text[0] != '\0' && text[3] == '\0') return from_utf16(text, 0, false);
  if (text.size() >= 4 && text[0] == '\0' && text[1] != '\0' && text[2] == '\0') return from_utf16(text, 0, true);
  return text;
}

}  // namespace host
