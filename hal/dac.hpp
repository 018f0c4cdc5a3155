// D/A converter that commands the current amplifier.
#pragma once

#include <concepts>
#include <cstdint>

namespace hal {

/// Contract: `write(code)` puts code * resolution volts on the output and holds them until the next call; code 0 is 0
/// V. The code is signed, and the board gives the resolution (axis board: 16 bits over -10..+10 V, 20/65536 V per
/// step). The control core converts volts to codes, so that every backend gets the same word. The caller keeps the code
/// inside the converter's range. Returns false when the transfer failed; the output is then unchanged or unknown.
/// `is_healthy()` is false when the converter, read back in the background, differs from its setting: brown-out, short
/// circuit, heat, broken wire. It then stays false until the board restarts the converter. Neither call waits.
template <typename T>
concept Dac = requires(T& dac, std::int32_t code) {
  { dac.write(code) } -> std::same_as<bool>;
  { dac.is_healthy() } -> std::same_as<bool>;
};

}  // namespace hal
