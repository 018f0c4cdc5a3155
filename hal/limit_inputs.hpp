// Switches at the ends of travel and at the home position.
#pragma once

#include <concepts>

namespace hal {

struct LimitState {
  bool positive_end = false;
  bool negative_end = false;
  bool home = false;
};

/// Contract: `read()` samples the inputs at this instant. true: the switch is actuated or its wire is broken (normally
/// closed contacts). The home input is normally open; there true means only actuated.
template <typename T>
concept LimitInputs = requires(T& inputs) {
  { inputs.read() } -> std::same_as<LimitState>;
};

}  // namespace hal
