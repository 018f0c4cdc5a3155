#include "host/opening/name_words.hpp"

#include <cstdint>

namespace host {

namespace {

enum class Sort { sign, digit, small, large, other };

Sort sort_of(char c) {
  if (c >= '0' && c <= '9') return Sort::digit;
  if (c >= 'a' && c <= 'z') return Sort::small;
  if (c >= 'A' && c <= 'Z') return Sort::large;
  return static_cast<std::uint8_t>(c) >= 0x80U ? Sort::other : Sort::sign;
}

/// Whether a word ends between the characters at `at - 1` and `at`.
bool is_border(std::string_view name, std::size_t at) {
  const Sort before = sort_of(name[at - 1]), here = sort_of(name[at]);
  if (before == Sort::digit || here == Sort::digit) return before != here;
  if (before == Sort::small && here == Sort::large) return true;
  return before == Sort::large && here == Sort::large && at + 1 < name.size() && sort_of(name[at + 1]) == Sort::small;
}

}  // namespace

std::string in_small_letters(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto byte = static_cast<std::uint8_t>(text[k]);
    const std::uint8_t next = k + 1 < text.size() ? static_cast<std::uint8_t>(text[k + 1]) : 0;
    if (byte >= 'A' && byte <= 'Z') {
      out += static_cast<char>(byte + ('a' - 'A'));
    } else if (byte == 0xC3U && next >= 0x80U && next <= 0x9EU && next != 0x97U) {  // À to Þ
      out += {text[k++], static_cast<char>(next + 0x20U)};
    } else if (byte == 0xD0U && next >= 0x90U && next <= 0x9FU) {  // А to П
      out += {text[k++], static_cast<char>(next + 0x20U)};
    } else if (byte == 0xD0U && next >= 0xA0U && next <= 0xAFU) {  // Р to Я
      out += {static_cast<char>(0xD1U), static_cast<char>(next - 0x20U)};
      ++k;
    } else {
      out += text[k];
    }
  }
  return out;
}

std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) words.push_back(in_small_letters(word));
    word.clear();
  };
  for (std::size_t k = 0; k < name.size(); ++k) {
    if (sort_of(name[k]) == Sort::sign) {
      end_word();
      continue;
    }
    if (!word.empty() && is_border(name, k)) end_word();
    word += name[k];
  }
  end_word();
  return words;
}

}  // namespace host
