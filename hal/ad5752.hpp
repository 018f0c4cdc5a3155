// Two-channel 16-bit D/A converter AD5752 behind any 24-bit serial transfer. References: datasheet rev. F.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>

#include "hal/dac.hpp"

namespace hal {

/// Contract: `send24` shifts 24 bits out, most significant first, framed by the select line. `exchange24` also returns
/// the 24 bits received, at a clock rate that allows it. Both return false if that failed. `pause_ns` waits at least
/// that long.
template <typename T>
concept Transfer24 = requires(T& port, std::uint32_t word, std::uint32_t& reply) {
  { port.send24(word) } -> std::same_as<bool>;
  { port.exchange24(word, reply) } -> std::same_as<bool>;
  { port.pause_ns(word) } -> std::same_as<void>;
};

/// State of the converter according to its registers.
enum class ConverterState : std::uint8_t {
  sound,
  silent,            ///< the serial port failed
  registers_differ,  ///< absent, unpowered, or with another range, code or setting than written: brown-out
  too_hot,           ///< has shut its outputs down
  overloaded,        ///< an output exceeds the current limit: short circuit
};

/// BIN/2sCOMP is tied low: codes are two's complement. -10 V..+10 V, 20/65536 V a step (table 8). LDAC is tied low, so
/// a channel follows its word at once. Calls must not interrupt each other.
template <Transfer24 Port>
class Ad5752 {
 public:
  explicit constexpr Ad5752(Port& port) : port_(port) {}
  Ad5752(const Ad5752&) = delete;
  Ad5752& operator=(const Ad5752&) = delete;

  class Channel {
   public:
    constexpr Channel(Ad5752& converter, std::uint32_t address) : converter_(converter), address_(address) {}
    bool write(std::int32_t code) {
      code_ = static_cast<std::uint32_t>(code) & 0xFFFF;
      return converter_.send(kDacRegister | address_ | code_);
    }
    bool is_healthy() const { return converter_.state() == ConverterState::sound; }

   private:
    friend class Ad5752;
    Ad5752& converter_;
    std::uint32_t address_;
    std::uint32_t code_ = 0;
  };

  /// Sets range, power and 0 V on both channels. False if the registers then read differently.
  bool start() {
    constexpr std::uint32_t kPowerUp_ns = 10'000;  // table 24: before that no word may reach an output
    a_.code_ = b_.code_ = 0;
    const bool sent = send(kRangeRegister | kBothChannels | kPlusMinus10V) &&
                      send(kControlRegister | kSetOptions | kClampCurrent | kThermalShutdown) &&
                      send(kDacRegister | kBothChannels) && send(kPowerRegister | kPowerBoth);
    port_.pause_ns(kPowerUp_ns);
    state_ = sent ? ConverterState::sound : ConverterState::silent;
    next_ = 0;
    for (std::size_t reading = 0; reading < kReadings; ++reading) watch();
    return state_ == ConverterState::sound;
  }

  /// Reads one register back, the next one at the next call. A difference is read again at once: a disturbance on the
  /// line disappears, a lost register does not. Any state except `sound` persists until start().
  void watch() {
    const Reading reading = expected(next_);
    next_ = (next_ + 1) % kReadings;
    const ConverterState first = compare(reading);
    if (state_ == ConverterState::sound && first != ConverterState::sound) state_ = compare(reading);
  }

  ConverterState state() const { return state_; }

  Channel& a() { return a_; }
  Channel& b() { return b_; }

 private:
  // Input shift register: R/W, 0, register (3 bits), address (3 bits), data (table 15).
  static constexpr std::uint32_t kRead = 1u << 23;
  static constexpr std::uint32_t kDacRegister = 0u << 19, kRangeRegister = 1u << 19, kPowerRegister = 2u << 19,
                                 kControlRegister = 3u << 19;                                           // table 17
  static constexpr std::uint32_t kChannelA = 0u << 16, kChannelB = 2u << 16, kBothChannels = 4u << 16;  // table 17
  static constexpr std::uint32_t kPlusMinus10V = 4, kRangeField = 7;                                    // table 21
  static constexpr std::uint32_t kNothing = 0u << 16, kSetOptions = 1u << 16;                           // table 22
  static constexpr std::uint32_t kClampCurrent = 1u << 2, kThermalShutdown = 1u << 3, kOptions = 0xF;   // table 23
  static constexpr std::uint32_t kPowerBoth = (1u << 0) | (1u << 2);                      // table 24: PUA, PUB
  static constexpr std::uint32_t kTooHot = 1u << 5, kOverloaded = (1u << 7) | (1u << 9);  // table 24: TSD, OCA, OCB
  static constexpr std::uint32_t kCode = 0xFFFF;
  // Time for which the select line is high between words: twice t6 = 100 ns and twice t17 = 200 ns. These times and
  // t16, 40 ns from a clock's rise to the answer's bit, are not verified: check them in the timing table before the
  // first power-up. If t16 is wrong, start() finds different registers before an output is on.
  static constexpr std::uint32_t kHighWriting_ns = 200, kHighReading_ns = 400;

  struct Reading {
    std::uint32_t word;
    std::uint32_t field;
    std::uint32_t value;
  };
  static constexpr std::size_t kReadings = 6;

  Reading expected(std::size_t which) const {
    const std::array<Reading, kReadings> all{{
        {kPowerRegister, kPowerBoth | kTooHot | kOverloaded, kPowerBoth},
        {kRangeRegister | kChannelA, kRangeField, kPlusMinus10V},
        {kRangeRegister | kChannelB, kRangeField, kPlusMinus10V},
        {kControlRegister | kSetOptions, kOptions, kClampCurrent | kThermalShutdown},
        {kDacRegister | kChannelA, kCode, a_.code_},
        {kDacRegister | kChannelB, kCode, b_.code_},
    }};
    return all[which];
  }

  bool send(std::uint32_t word) {
    port_.pause_ns(kHighWriting_ns);
    return port_.send24(word);
  }

  /// This word requests the register. The next one, which has no effect, transfers the answer.
  ConverterState compare(const Reading& reading) {
    std::uint32_t reply = 0;
    port_.pause_ns(kHighReading_ns);
    if (!port_.exchange24(kRead | reading.word, reply)) return ConverterState::silent;
    port_.pause_ns(kHighReading_ns);
    if (!port_.exchange24(kControlRegister | kNothing, reply)) return ConverterState::silent;
    port_.pause_ns(kHighReading_ns);
    if ((reply & reading.field) == reading.value) return ConverterState::sound;
    if (reading.word != kPowerRegister || (reply & kCode) == kCode) return ConverterState::registers_differ;
    if ((reply & kTooHot) != 0) return ConverterState::too_hot;
    return (reply & kOverloaded) != 0 ? ConverterState::overloaded : ConverterState::registers_differ;
  }

  Port& port_;
  Channel a_{*this, kChannelA};
  Channel b_{*this, kChannelB};
  ConverterState state_ = ConverterState::silent;
  std::size_t next_ = 0;
};

}  // namespace hal
