// Hides the origin of a word from the compiler. Used where this makes the compiler generate better code.
#pragma once

#include <type_traits>

namespace firmware {

/// The compiler then knows neither that the word is part of a longer one or was extended, nor that a sum could be
/// reordered.
template <typename Word>
constexpr void hide_origin(Word& word) {
  if (!std::is_constant_evaluated()) asm("" : "+r"(word));
}

}  // namespace firmware
