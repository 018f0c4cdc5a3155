// The analogue-to-digital converter with the DMA stream that empties it. RM0090, chapters 13 and 10.
#pragma once

#include <array>
#include <functional>

#include "tests/hal/parts/bus.hpp"

namespace parts {

/// Streams 0 to 7 of a controller, from the periphery to memory.
class DmaPart : public Part {
 public:
  explicit DmaPart(Bus& bus) : bus_(bus) {}

  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override;

  /// The periphery at `channel` of a stream has a half-word at this address. False when the stream does not take it.
  bool request(unsigned stream, unsigned channel, std::uint32_t address, std::uint16_t value);
  /// The periphery at `channel` asks for a word from the address that the stream has; a stream that is off takes none.
  void request_word(unsigned stream, unsigned channel);
  /// A bus error during a transfer ends the stream (10.3.18).
  void fail(unsigned stream) { streams_[stream].control &= ~1u; }
  /// Addresses have 32 bits on the chip, so a buffer of the test is identified by the lower 32 bits of its address.
  void knows(volatile std::uint16_t* memory, std::size_t count) { memory_ = memory, count_ = count; }

  bool is_stalled = false;                    ///< the bus is taken by others for too long
  std::function<void(unsigned)> on_complete;  ///< called with the stream's number, if its interrupt is enabled

 private:
  struct Stream;
  bool takes(const Stream& stream, unsigned channel) const;
  bool put(unsigned number, std::uint32_t value, unsigned bytes);

  struct Stream {
    std::uint32_t control = 0, left = 0, periphery = 0, memory = 0, memory1 = 0, fifo = 0x21, length = 0;
  };
  Bus& bus_;
  std::array<Stream, 8> streams_{};
  std::uint32_t low_flags_ = 0, high_flags_ = 0;
  volatile std::uint16_t* memory_ = nullptr;
  std::size_t count_ = 0;
};

class AdcPart : public Part {
 public:
  AdcPart(Bus& bus, DmaPart& dma, std::function<double()> clock_Hz)
      : bus_(bus), dma_(dma), clock_Hz_(std::move(clock_Hz)) {}

  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void run(double now_ns) override;
  void reset() override;

  /// The trigger output of TIM3.
  void trigger_timer3();

  std::function<double(unsigned)> input_V = [](unsigned) { return 1.65; };  ///< of a channel; the reference is 3.3 V
  std::function<void()> on_interrupt;                                       ///< overrun
  /// False: the pin of this channel is not analogue.
  std::function<bool(unsigned)> is_wired = [](unsigned) { return true; };

 private:
  double conversion_ns(unsigned channel) const;
  unsigned channel_at(unsigned place) const;
  void finish_conversion();

  Bus& bus_;
  DmaPart& dma_;
  std::function<double()> clock_Hz_;
  std::array<std::uint32_t, 20> registers_{};
  std::uint32_t common_ = 0, status_ = 0;
  double on_since_ns_ = 0.0, ready_at_ns_ = 0.0;
  unsigned place_ = 0;
  bool converts_ = false, requests_blocked_ = false;
};

}  // namespace parts
