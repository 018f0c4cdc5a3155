#include "tests/hal/parts/watchdog_part.hpp"

namespace parts {

void IndependentWatchdogPart::reset() {
  prescaler_ = 0;
  reload_ = 0xFFF;
  runs_ = unlocked_ = false;
  prescaler_ready_ns_ = reload_ready_ns_ = 0.0;
}

std::uint32_t IndependentWatchdogPart::read(std::uint32_t offset) {
  const double now = bus_.now_ns();
  switch (offset) {
    case 0x04:
      return prescaler_;
    case 0x08:
      return reload_;
    case 0x0C:
      return (now < prescaler_ready_ns_ ? 1u : 0u) | (now < reload_ready_ns_ ? 2u : 0u);
    default:
      return 0;
  }
}

void IndependentWatchdogPart::write(std::uint32_t offset, std::uint32_t value) {
  const double now = bus_.now_ns();
  const auto feed = [&] {
    fed_at_ns_ = now;
    if (now < reload_ready_ns_ || now < prescaler_ready_ns_)
      bus_.complain("iwdg: fed before the new time-out has arrived: the old one counts");
    else
      fed_for_ns_ = timeout_ns();
  };
  switch (offset) {
    case 0x00:  // 21.4.1: any other key protects the registers again
      unlocked_ = value == 0x5555;
      if (value == 0xCCCC && !runs_) {
        runs_ = true;
        feed();
      }
      if (value == 0xAAAA) feed();
      break;
    case 0x04:
      if (!unlocked_ || now < prescaler_ready_ns_) return bus_.complain("iwdg: prescaler written in vain");
      prescaler_ = value & 7;
      prescaler_ready_ns_ = now + update_ns();
      break;
    case 0x08:
      if (!unlocked_ || now < reload_ready_ns_) return bus_.complain("iwdg: reload value written in vain");
      reload_ = value & 0xFFF;
      reload_ready_ns_ = now + update_ns();
      break;
    default:
      break;
  }
}

void IndependentWatchdogPart::run(double now_ns) {
  if (runs_ && now_ns - fed_at_ns_ > fed_for_ns_) throw ChipReset("independent watchdog");
}

void WindowWatchdogPart::reset() { control_ = configuration_ = 0x7F; }

std::uint32_t WindowWatchdogPart::read(std::uint32_t offset) {
  if (!is_clocked_()) return 0;
  return offset == 0 ? control_ : offset == 4 ? configuration_ : 0;
}

void WindowWatchdogPart::write(std::uint32_t offset, std::uint32_t value) {
  if (!is_clocked_()) return;
  if (offset == 4) configuration_ = value & 0x3FF;
  if (offset != 0) return;
  // 22.3: a refresh while the counter is above the window resets, and so does one without bit T6.
  if (is_running() && (control_ & 0x7F) > (configuration_ & 0x7F))
    throw ChipReset("window watchdog: refreshed too early");
  if ((is_running() || bits(value, 7) != 0) && bits(value, 6) == 0) throw ChipReset("window watchdog: T6 written as 0");
  control_ = (value & 0xFF) | (control_ & 0x80);  // 22.6.1: WDGA is set once
}

void WindowWatchdogPart::run(double now_ns) {
  const double tick_ns = 1e9 * 4096 * (1u << bits(configuration_, 7, 2)) / clock_Hz_();  // 22.4
  if (is_clocked_()) phase_ns_ += now_ns - ran_until_ns_;  // 7.3.13: its clock can be switched off
  ran_until_ns_ = now_ns;
  while (phase_ns_ >= tick_ns) {
    phase_ns_ -= tick_ns;
    const std::uint32_t counter = control_ & 0x7F;
    control_ = (control_ & 0x80) | ((counter - 1) & 0x7F);
    if (is_running() && (counter - 1) < 0x40) throw ChipReset("window watchdog: not refreshed in time");
  }
}

}  // namespace parts
