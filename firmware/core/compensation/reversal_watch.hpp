// To which side a reference moves.
#pragma once

#include "firmware/core/arithmetic/count_position.hpp"

namespace firmware {

class ReversalWatch {
 public:
  constexpr void reset() { *this = {}; }

  /// Each increment of the reference: whether it has turned round. One at rest may dither by its rounding, which is no
  /// reversal.
  constexpr bool turns(Increment reference) {
    const int direction = reference > 0 ? 1 : (reference < 0 ? -1 : side_);
    if (direction == side_) {
      if (reference != 0) back_ = 0;
      return false;
    }
    back_ += reference;
    if (back_ < kReversal && back_ > -kReversal) return false;
    side_ = direction;
    back_ = 0;
    return true;
  }

  /// 1 forward, -1 backward, 0 before the first motion.
  constexpr int side() const { return side_; }

 private:
  static constexpr Increment kReversal = kOneCount / 16;

  Increment back_ = 0;
  int side_ = 0;
};

}  // namespace firmware
