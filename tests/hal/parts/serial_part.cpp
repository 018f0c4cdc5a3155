#include "tests/hal/parts/serial_part.hpp"

#include <cmath>

namespace parts {

void SerialPart::reset() {
  divider_ = control_ = 0;
  has_arrived_ = overrun_ = waits_ = shifts_ = false;
}

/// 30.3.4: with 16-fold oversampling a bit is BRR clocks; start, eight data, stop.
double SerialPart::character_ns() const { return 10.0 * divider_ / clock_Hz_() * 1e9; }

std::uint32_t SerialPart::read(std::uint32_t offset) {
  switch (offset) {
    case 0x00:  // 30.6.1
      return (overrun_ ? 1u << 3 : 0u) | (has_arrived_ ? 1u << 5 : 0u) | (shifts_ || waits_ ? 0u : 1u << 6) |
             (waits_ ? 0u : 1u << 7);
    case 0x04:
      has_arrived_ = overrun_ = false;
      return arrived_;
    case 0x08:
      return divider_;
    case 0x0C:
      return control_;
    default:
      return other_[(offset - 0x10) / 4 % 2];
  }
}

void SerialPart::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x04:
      if (bits(control_, 13) == 0 || bits(control_, 3) == 0) return;  // UE, TE
      if (waits_) bus_.complain("usart: DR written while it is full: a character is lost");
      waiting_ = value & 0xFF;
      waits_ = true;
      run(bus_.now_ns());
      break;
    case 0x08:
      divider_ = value & 0xFFFF;
      break;
    case 0x0C:
      control_ = value;
      break;
    case 0x10:
    case 0x14:
      other_[(offset - 0x10) / 4] = value;
      break;
    default:
      break;
  }
}

void SerialPart::run(double now_ns) {
  if (shifts_ && now_ns >= done_at_ns_) {
    shifts_ = false;
    const double rate = divider_ == 0 ? 0.0 : clock_Hz_() / divider_;
    sent_ += std::abs(rate - baud_) < 0.02 * baud_ ? static_cast<char>(shifting_) : '?';
  }
  if (waits_ && !shifts_) {
    waits_ = false;
    shifts_ = true;
    shifting_ = waiting_;
    done_at_ns_ = now_ns + character_ns();
  }
}

void SerialPart::type(char character) {
  if (bits(control_, 13) == 0 || bits(control_, 2) == 0) return;  // UE, RE
  if (has_arrived_) {
    overrun_ = true;  // 30.3.3: the new character is lost
    return;
  }
  const double rate = divider_ == 0 ? 0.0 : clock_Hz_() / divider_;
  arrived_ = std::abs(rate - baud_) < 0.02 * baud_ ? static_cast<unsigned char>(character) : '?';
  has_arrived_ = true;
}

}  // namespace parts
