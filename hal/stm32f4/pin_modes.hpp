// Checks whether the pins of three ports still have the modes that were set. RM0090, section 8.4.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

/// Modes, output types, edge speeds, pulls and alternate functions. Levels are not compared.
class PinModes {
 public:
  /// Call it once all pins have been set.
  void remember() { set_ = now(); }
  /// Reads 18 registers.
  bool are_kept() const { return now() == set_; }

 private:
  using OfPort = std::array<std::uint32_t, 6>;
  using OfPorts = std::array<OfPort, 3>;

  static OfPort of(const Gpio& port) {
    return {port.MODER, port.OTYPER, port.OSPEEDR, port.PUPDR, port.AFR[0], port.AFR[1]};
  }
  static OfPorts now() { return {of(gpio_a()), of(gpio_b()), of(gpio_c())}; }

  OfPorts set_{};
};

}  // namespace hal::stm32f4
