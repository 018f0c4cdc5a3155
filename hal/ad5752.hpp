// Two-channel 16-bit D/A converter AD5752 behind any 24-bit serial transfer. References: datasheet rev. F.
#pragma once

#include <concepts>
#include <cstdint>

#include "hal/dac.hpp"

namespace hal {

/// Contract: `send24` shifts 24 bits out, most significant first, framed by the select line; false when that failed.
template <typename T>
concept Transfer24 = requires(T& port, std::uint32_t word) {
  { port.send24(word) } -> std::same_as<bool>;
};

/// BIN/2sCOMP is tied low: codes are two's complement. -10 V..+10 V, 20/65536 V a step (table 8). LDAC is tied low, so
/// a channel follows its word at once.
template <Transfer24 Port>
class Ad5752 {
 public:
  explicit constexpr Ad5752(Port& port) : port_(port) {}

  class Channel {
   public:
    constexpr Channel(Port& port, std::uint32_t address) : port_(port), address_(address) {}
    bool write(std::int32_t code) {
      return port_.send24(kDacRegister | address_ | (static_cast<std::uint32_t>(code) & 0xFFFF));
    }

   private:
    Port& port_;
    std::uint32_t address_;
  };

  /// Range, power and 0 V on both channels.
  bool start() {
    return port_.send24(kRangeRegister | kBothChannels | kPlusMinus10V) &&
           port_.send24(kControlRegister | kSetOptions | kClampCurrent | kThermalShutdown) &&
           port_.send24(kDacRegister | kBothChannels) && port_.send24(kPowerRegister | kPowerBoth);
  }

  Channel& a() { return a_; }
  Channel& b() { return b_; }

 private:
  // Input shift register: R/W, 0, register (3 bits), address (3 bits), data (table 15).
  static constexpr std::uint32_t kDacRegister = 0u << 19, kRangeRegister = 1u << 19, kPowerRegister = 2u << 19,
                                 kControlRegister = 3u << 19;                                           // table 17
  static constexpr std::uint32_t kChannelA = 0u << 16, kChannelB = 2u << 16, kBothChannels = 4u << 16;  // table 17
  static constexpr std::uint32_t kPlusMinus10V = 4;                                                     // table 21
  static constexpr std::uint32_t kSetOptions = 1u << 16, kClampCurrent = 1u << 2, kThermalShutdown = 1u << 3;  // 22, 23
  static constexpr std::uint32_t kPowerBoth = (1u << 0) | (1u << 2);  // table 24: PUA, PUB

  Port& port_;
  Channel a_{port_, kChannelA};
  Channel b_{port_, kChannelB};
};

}  // namespace hal
