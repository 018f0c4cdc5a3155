#include "tests/hal/parts/port_part.hpp"

namespace parts {

void PortPart::reset() {
  mode_ = letter_ == 'A' ? 0xA8000000 : letter_ == 'B' ? 0x00000280 : 0;  // 8.4.1
  pull_ = letter_ == 'A' ? 0x64000000 : letter_ == 'B' ? 0x00000100 : 0;  // 8.4.4
  speed_ = letter_ == 'B' ? 0x000000C0 : 0;
  type_ = output_ = 0;
  function_ = {};
  tell_changes();
}

Drive PortPart::drive(unsigned pin) const {
  const std::uint32_t mode = bits(mode_, 2 * pin, 2), pull = bits(pull_, 2 * pin, 2);
  const bool high = bits(output_, pin) != 0;
  if (mode == 1 && !(high && bits(type_, pin) != 0)) return high ? Drive::high : Drive::low;
  if (mode == 3) return Drive::floating;
  return pull == 1 ? Drive::pulled_up : pull == 2 ? Drive::pulled_down : Drive::floating;
}

bool PortPart::level(unsigned pin) const {
  switch (drive(pin)) {
    case Drive::low:
      return false;
    case Drive::high:
      return true;
    case Drive::pulled_up:
      return outside_[pin] != Outside::low;
    case Drive::pulled_down:
    case Drive::floating:
      break;
  }
  return outside_[pin] == Outside::high;
}

int PortPart::function(unsigned pin) const {
  return bits(mode_, 2 * pin, 2) == 2 ? static_cast<int>(bits(function_[pin / 8], pin % 8 * 4, 4)) : -1;
}

bool PortPart::input(unsigned pin) const {
  return !is_analogue(pin) && level(pin);  // 8.3.12: an analogue pin reads 0
}

std::uint32_t PortPart::read(std::uint32_t offset) {
  switch (offset) {
    case 0x00:
      return mode_;
    case 0x04:
      return type_;
    case 0x08:
      return speed_;
    case 0x0C:
      return pull_;
    case 0x10: {
      std::uint32_t value = 0;
      for (unsigned pin = 0; pin < 16; ++pin) value |= (input(pin) ? 1u : 0u) << pin;
      return value;
    }
    case 0x14:
      return output_;
    case 0x20:
    case 0x24:
      return function_[(offset - 0x20) / 4];
    default:
      return 0;
  }
}

void PortPart::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x00:
      mode_ = value;
      break;
    case 0x04:
      type_ = value;
      break;
    case 0x08:
      speed_ = value;
      break;
    case 0x0C:
      pull_ = value;
      break;
    case 0x10:
      return bus_.complain("port: IDR cannot be written");
    case 0x14:
      output_ = value & 0xFFFF;
      break;
    case 0x18:
      output_ = ((output_ & ~(value >> 16)) | (value & 0xFFFF)) & 0xFFFF;  // 8.4.7: setting wins
      break;
    case 0x20:
    case 0x24:
      function_[(offset - 0x20) / 4] = value;
      break;
    default:
      return;
  }
  tell_changes();
}

void PortPart::tell_changes() {
  for (unsigned pin = 0; pin < 16; ++pin) {
    const Drive now = drive(pin);
    if (now == told_[pin]) continue;
    told_[pin] = now;
    if (on_change[pin]) on_change[pin](now);
  }
}

}  // namespace parts
