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

/// Converts pairs of bytes from `begin` on. `big_end_first`: the first byte of a pair is the high one.
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

/// Length of the UTF-8 character at `at`; 0 if there is none.
std::size_t utf8_length(const std::string& text, std::size_t at) {
  const auto lead = static_cast<std::uint8_t>(text[at]);
  const std::size_t length = lead < 0x80U                    ? 1
                             : lead >= 0xC2U && lead < 0xE0U ? 2
                             : lead >= 0xE0U && lead < 0xF0U ? 3
                             : lead >= 0xF0U && lead < 0xF5U ? 4
                                                             : 0;
  if (at + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((static_cast<std::uint8_t>(text[at + k]) & 0xC0U) != 0x80U) return 0;
  return length;
}

bool is_utf8(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    if (length == 0) return false;
    at += length;
  }
  return true;
}

/// Bytes 0x80 to 0x9F of Windows-1252 (Unicode consortium, CP1252.TXT); 0 for undefined bytes.
constexpr std::uint16_t kWindows1252[32] = {0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021,
                                            0x02C6, 0x2030, 0x0160, 0x2039, 0x0152, 0,      0x017D, 0,
                                            0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022, 0x2013, 0x2014,
                                            0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

std::string from_windows_1252(const std::string& text) {
  std::string out;
  out.reserve(text.size() + text.size() / 8);
  for (const char c : text) {
    const auto byte = static_cast<std::uint8_t>(c);
    append_utf8(byte >= 0x80U && byte < 0xA0U && kWindows1252[byte - 0x80U] != 0 ? kWindows1252[byte - 0x80U] : byte,
                out);
  }
  return out;
}

}  // namespace

std::string as_utf8(std::string text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // the bytes after the mark may still be invalid
  if (text.starts_with("\xFF\xFE")) return from_utf16(text, 2, false);
  if (text.starts_with("\xFE\xFF")) return from_utf16(text, 2, true);
  if (text.size() >= 4 && text[1] == '\0' && text[0] != '\0' && text[3] == '\0') return from_utf16(text, 0, false);
  if (text.size() >= 4 && text[0] == '\0' && text[1] != '\0' && text[2] == '\0') return from_utf16(text, 0, true);
  return is_utf8(text) ? text : from_windows_1252(text);
}

}  // namespace host
