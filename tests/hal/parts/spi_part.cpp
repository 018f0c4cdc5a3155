#include "tests/hal/parts/spi_part.hpp"

namespace parts {

void SpiPart::reset() {
  control_ = control2_ = 0;
  half_bits_left_ = 0;
  has_arrived_ = has_waiting_ = overrun_ = false;
}

/// 28.5.1: SPE, MSTR, and the select input held high by software (SSM, SSI), else the port is no master (28.3.10).
bool SpiPart::master() const {
  return bits(control_, 6) != 0 && bits(control_, 2) != 0 && bits(control_, 9) != 0 && bits(control_, 8) != 0;
}

std::uint32_t SpiPart::read(std::uint32_t offset) {
  switch (offset) {
    case 0x00:
      return control_;
    case 0x04:
      return control2_;
    case 0x08:  // 28.5.3
      return (has_arrived_ ? 1u : 0u) | (has_waiting_ ? 0u : 2u) | (overrun_ ? 1u << 6 : 0u) |
             (half_bits_left_ > 0 || has_waiting_ ? 1u << 7 : 0u);
    case 0x0C:
      has_arrived_ = overrun_ = false;
      return arrived_;
    default:
      return 0;
  }
}

void SpiPart::write(std::uint32_t offset, std::uint32_t value) {
  if (offset == 0x00) {
    constexpr std::uint32_t kFormat = 0x8BF;  // DFF, LSBFIRST, BR, MSTR, CPOL, CPHA: 28.3.3
    if (((value ^ control_) & kFormat & ~0x38u) != 0 && bits(control_, 6) != 0)
      bus_.complain("spi: format changed while the port is on");
    if (half_bits_left_ > 0) bus_.complain("spi: control register written during a transfer");
    control_ = value;
    if (bits(control_, 6) != 0) clock_line(bits(control_, 1) != 0, bus_.now_ns());
  } else if (offset == 0x04) {
    control2_ = value;
  } else if (offset == 0x0C) {
    if (!master()) return;
    if (half_bits_left_ == 0) return begin(value & 0xFF, bus_.now_ns());
    if (has_waiting_) bus_.complain("spi: DR written while the transmit buffer is full: a byte is lost");
    waiting_ = value & 0xFF;
    has_waiting_ = true;
  }
}

void SpiPart::begin(std::uint32_t byte, double at_ns) {
  shifting_ = byte;
  received_ = 0;
  half_bits_left_ = 16;
  next_edge_ns_ = at_ns;
  if (bits(control_, 0) == 0 && slave != nullptr && is_wired())  // CPHA 0: the first bit waits for no edge
    slave->data_line(bits(shifting_, bits(control_, 7) != 0 ? 0 : 7) != 0, at_ns);
  const double half_bit_ns = 0.5e9 * (2u << bits(control_, 3, 3)) / clock_Hz_();
  next_edge_ns_ = at_ns + half_bit_ns;
}

void SpiPart::clock_line(bool level, double at_ns) {
  if (level == clock_level_) return;
  clock_level_ = level;
  if (slave != nullptr && is_wired()) slave->clock_line(level, at_ns);
}

/// One edge of the clock. CPHA decides whether data change at the first edge of a bit or at its second (28.3.1).
void SpiPart::half_bit(double at_ns) {
  const bool wired = slave != nullptr && is_wired();
  const bool second_phase = bits(control_, 0) != 0, lowest_first = bits(control_, 7) != 0;
  const int number = 16 - half_bits_left_;  // 0 to 15
  const bool leading = number % 2 == 0;
  const auto bit_of = [&](int place) { return bits(shifting_, lowest_first ? place : 7 - place) != 0; };
  const bool samples = leading != second_phase;
  if (samples) {
    const bool answer = wired && slave->answer_line(at_ns);
    const int place = number / 2;
    received_ |= (answer ? 1u : 0u) << (lowest_first ? place : 7 - place);
  }
  clock_line(!clock_level_, at_ns);
  if (!samples && wired) {
    const int next = second_phase ? number / 2 : number / 2 + 1;
    if (next < 8) slave->data_line(bit_of(next), at_ns);
  }
  --half_bits_left_;
}

void SpiPart::run(double now_ns) {
  const double half_bit_ns = 0.5e9 * (2u << bits(control_, 3, 3)) / clock_Hz_();
  while (half_bits_left_ > 0 && next_edge_ns_ <= now_ns && !is_dead) {
    const double at = next_edge_ns_;
    half_bit(at);
    next_edge_ns_ = at + half_bit_ns;
    if (half_bits_left_ > 0) continue;
    overrun_ = overrun_ || has_arrived_;
    if (!has_arrived_) arrived_ = received_;  // 28.3.10: the new byte is lost
    has_arrived_ = true;
    if (has_waiting_) {
      has_waiting_ = false;
      begin(waiting_, at);
    }
  }
}

}  // namespace parts
