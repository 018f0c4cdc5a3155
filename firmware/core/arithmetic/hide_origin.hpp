// Where the compiler makes better code of a word when it does not know where it comes from.
#pragma once

#include <type_traits>

namespace firmware {

/// From here on it knows of the word neither a longer one that it is part of or has been extended to, nor the sum that
/// it could make in another order.
template <typename Word>
constexpr void hide_origin(Word& word) {
  if (!std::is_constant_evaluated()) asm("" : "+r"(word));
}

}  // namespace firmware
