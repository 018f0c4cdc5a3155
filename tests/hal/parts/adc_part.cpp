#include "tests/hal/parts/adc_part.hpp"

#include <algorithm>
#include <cmath>

namespace parts {

namespace {

constexpr std::uint32_t kTransferComplete = 1u << 5, kStreamFlags = 0x3D;        // LISR, stream 0: 10.5.1
constexpr std::uint32_t kDataRegister = 0x4001204C;                              // ADC1_DR
constexpr std::uint32_t kOverrun = 1u << 5, kEnd = 1u << 1, kStarted = 1u << 4;  // SR: 13.13.1
enum : std::uint32_t { kCr1 = 1, kCr2 = 2, kSmpr1 = 3, kSmpr2 = 4, kSqr1 = 11, kSqr2 = 12, kSqr3 = 13 };

}  // namespace

void DmaPart::reset() {
  streams_ = {};
  low_flags_ = high_flags_ = 0;
}

std::uint32_t DmaPart::read(std::uint32_t offset) {
  if (offset == 0x00) return low_flags_;
  if (offset == 0x04) return high_flags_;
  if (offset < 0x10) return 0;
  const Stream& stream = streams_[(offset - 0x10) / 0x18];
  const std::uint32_t words[6] = {stream.control, stream.left,    stream.periphery,
                                  stream.memory,  stream.memory1, stream.fifo};
  return words[(offset - 0x10) % 0x18 / 4];
}

void DmaPart::write(std::uint32_t offset, std::uint32_t value) {
  if (offset == 0x08) low_flags_ &= ~value;
  if (offset == 0x0C) high_flags_ &= ~value;
  if (offset < 0x10) return;
  const unsigned number = (offset - 0x10) / 0x18;
  Stream& stream = streams_[number];
  const bool is_on = bits(stream.control, 0) != 0;
  const unsigned word = (offset - 0x10) % 0x18 / 4;
  if (is_on && word != 0) return bus_.complain("dma: stream configured while it is on: lost");  // 10.3.17
  switch (word) {
    case 0:
      if (is_on && (value & ~0x1Fu) != (stream.control & ~0x1Fu))
        bus_.complain("dma: stream's control changed while it is on");
      if (!is_on && bits(value, 0) != 0) {
        if (number == 0 && (low_flags_ & kStreamFlags) != 0)
          bus_.complain("dma: stream started with flags of the last transfer");  // 10.3.17, step 1
        stream.length = stream.left;
      }
      stream.control = value;
      break;
    case 1:
      stream.left = value & 0xFFFF;
      break;
    case 2:
      stream.periphery = value;
      break;
    case 3:
      stream.memory = value;
      break;
    case 4:
      stream.memory1 = value;
      break;
    default:
      stream.fifo = value;
  }
}

bool DmaPart::takes(const Stream& stream, unsigned channel) const {
  return !is_stalled && bits(stream.control, 0) != 0 && bits(stream.control, 25, 3) == channel && stream.left != 0;
}

bool DmaPart::request(unsigned number, unsigned channel, std::uint32_t address, std::uint16_t value) {
  if (!takes(streams_[number], channel) || streams_[number].periphery != address) return false;
  return put(number, value, 2);
}

void DmaPart::request_word(unsigned number, unsigned channel) {
  if (takes(streams_[number], channel)) put(number, bus_.read_by_dma(streams_[number].periphery), 4);
}

bool DmaPart::put(unsigned number, std::uint32_t value, unsigned bytes) {
  Stream& stream = streams_[number];
  const std::uint32_t control = stream.control;
  const bool fits = bits(control, 11, 2) == bytes / 2 && bits(control, 13, 2) == bytes / 2;
  if (bits(control, 6, 2) != 0 || !fits) {
    bus_.complain("dma: direction or size of the transfer");
    return true;
  }
  const auto known = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(memory_));
  const std::uint32_t place = bits(control, 10) != 0 ? stream.length - stream.left : 0;
  const std::size_t index = (stream.memory - known) / 2 + place * bytes / 2;
  if (memory_ == nullptr || index + bytes / 2 > count_) {
    bus_.complain("dma: writes where no buffer is");
  } else {
    memory_[index] = static_cast<std::uint16_t>(value);
    if (bytes == 4) memory_[index + 1] = static_cast<std::uint16_t>(value >> 16);
  }
  if (bits(control, 9) != 0) bus_.complain("dma: the peripheral's address moves on");
  if (--stream.left > 0) return true;
  if (bits(control, 8) != 0)
    stream.left = stream.length;
  else
    stream.control &= ~1u;
  if (number == 0) low_flags_ |= kTransferComplete;
  if (bits(control, 4) != 0 && on_complete) on_complete(number);
  return true;
}

void AdcPart::reset() {
  registers_ = {};
  common_ = status_ = 0;
  converts_ = requests_blocked_ = false;
}

std::uint32_t AdcPart::read(std::uint32_t offset) {
  if (offset == 0x304) return common_;
  if (offset == 0x00) return status_;
  return offset / 4 < registers_.size() ? registers_[offset / 4] : 0;
}

void AdcPart::write(std::uint32_t offset, std::uint32_t value) {
  if (offset == 0x304) {
    common_ = value;
    return;
  }
  if (offset == 0x00) {
    const bool had_overrun = (status_ & kOverrun) != 0;
    status_ &= value;
    if (had_overrun && (status_ & kOverrun) == 0) requests_blocked_ = false;
    return;
  }
  if (offset / 4 >= registers_.size()) return;
  if (offset / 4 == kCr2) {
    if (bits(value, 0) != 0 && bits(registers_[kCr2], 0) == 0) on_since_ns_ = bus_.now_ns();
    if (bits(value, 0) == 0) converts_ = false;
  }
  registers_[offset / 4] = value;
}

double AdcPart::conversion_ns(unsigned channel) const {
  constexpr double kSampling[8] = {3, 15, 28, 56, 84, 112, 144, 480};  // 13.13.4
  const double clock = clock_Hz_() / (2 * (bits(common_, 16, 2) + 1));
  const std::uint32_t field =
      channel >= 10 ? bits(registers_[kSmpr1], 3 * (channel - 10), 3) : bits(registers_[kSmpr2], 3 * channel, 3);
  return 1e9 * (kSampling[field] + 12) / clock;  // 13.5
}

unsigned AdcPart::channel_at(unsigned place) const {
  const unsigned where = place < 6 ? kSqr3 : place < 12 ? kSqr2 : kSqr1;
  return bits(registers_[where], place % 6 * 5, 5);
}

void AdcPart::trigger_timer3() {
  const std::uint32_t control = registers_[kCr2];
  const bool wanted = bits(control, 28, 2) == 1 && bits(control, 24, 4) == 8;  // 13.6, table 68
  if (!wanted || bits(control, 0) == 0 || converts_) return;
  if ((status_ & kOverrun) != 0) return;      // 13.8.1: further triggers are ignored
  constexpr double kStabilisation_ns = 3000;  // datasheet, table 67
  if (bus_.now_ns() - on_since_ns_ < kStabilisation_ns) bus_.complain("adc: triggered before it has settled");
  if (clock_Hz_() / (2 * (bits(common_, 16, 2) + 1)) > 36e6) bus_.complain("adc: clock above 36 MHz");
  converts_ = true;
  status_ |= kStarted;
  place_ = 0;
  ready_at_ns_ = bus_.now_ns() + conversion_ns(channel_at(0));
}

void AdcPart::finish_conversion() {
  const unsigned channel = channel_at(place_);
  const double volts = is_wired(channel) ? input_V(channel) : 0.0;
  const auto code = static_cast<std::uint16_t>(std::clamp(std::floor(volts / 3.3 * 4096.0), 0.0, 4095.0));
  registers_[19] = code;
  const std::uint32_t control = registers_[kCr2];
  bool taken = false;
  if (bits(control, 8) != 0 && !requests_blocked_) taken = dma_.request(0, 0, kDataRegister, code);
  if (!taken) {
    // 13.8.1: no further request is issued, the conversion is aborted, until the flag is cleared.
    if ((status_ & kEnd) != 0 || bits(control, 8) != 0) {
      status_ |= kOverrun;
      requests_blocked_ = true;
      converts_ = false;
      if (bits(registers_[kCr1], 26) != 0 && on_interrupt) on_interrupt();
      return;
    }
    status_ |= kEnd;
  }
  const unsigned length = bits(registers_[kCr1], 8) != 0 ? bits(registers_[kSqr1], 20, 4) + 1 : 1;
  if (++place_ < length) {
    ready_at_ns_ += conversion_ns(channel_at(place_));
    return;
  }
  converts_ = false;
  if (bits(control, 9) == 0) requests_blocked_ = true;  // 13.8.1: without DDS the last transfer ends the requests
}

void AdcPart::run(double now_ns) {
  while (converts_ && ready_at_ns_ <= now_ns) finish_conversion();
}

}  // namespace parts
