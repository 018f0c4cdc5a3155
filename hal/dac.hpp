// D/A converter that commands the current amplifier.
#pragma once

#include <concepts>
#include <cstdint>

namespace hal {

/// Contract: `write(code)` puts code * resolution volts on the output and holds them until the next call; code 0 is 0
/// V. The code is signed, and the resolution is the board's (axis board: 16 bits over -10..+10 V, 20/65536 V a step).
/// Volts become codes in the control core, so that every backend is handed the same word. The caller keeps the code
/// inside the converter's range. Returns false when the transfer failed; the output then is what it was, or unknown.
/// `is_healthy()` is false when the converter, read back in the background, is not as it was set: brown-out, short
/// circuit, heat, broken wire. It then stays false until the board starts the converter anew. Neither call waits.
template <typename T>
concept Dac = requires(T& dac, std::int32_t code) {
  { dac.write(code) } -> std::same_as<bool>;
  { dac.is_healthy() } -> std::same_as<bool>;
};

}  // namespace hal
