#include "tests/hal/parts/clock_part.hpp"

namespace parts {

namespace {

constexpr std::uint32_t kHsiOn = 1u << 0, kHsiReady = 1u << 1, kHseOn = 1u << 16, kHseReady = 1u << 17,
                        kPllOn = 1u << 24, kPllReady = 1u << 25;                                  // 7.3.1
constexpr std::uint32_t kControlReset = 0x83, kPllReset = 0x24003010, kStatusReset = 0x0E000000;  // 7.3.1, .2, .21
constexpr std::uint32_t kHsi = 0, kHse = 1, kPll = 2;                                             // CFGR.SW, 7.3.3
constexpr double kHsi_Hz = 16e6;
constexpr double kHsiStart_ns = 4e3, kHseStart_ns = 2e6, kPllLock_ns = 3e5;  // datasheet, tables 34, 33, 36

unsigned bus_divider(std::uint32_t field) { return field < 4 ? 1 : 2u << (field - 4); }

}  // namespace

std::uint32_t PowerPart::read(std::uint32_t offset) {
  if (offset == 0) return control_;
  constexpr double kThresholds_V[] = {2.0, 2.1, 2.3, 2.5, 2.6, 2.7, 2.8, 2.9};  // 5.4.1, PLS
  const bool watched = bits(control_, 4) != 0;
  return watched && supply_V < kThresholds_V[bits(control_, 5, 3)] ? 1u << 2 : 0u;  // 5.4.2, PVDO
}

void PowerPart::write(std::uint32_t offset, std::uint32_t value) {
  if (offset == 0) control_ = value;
}

ClockPart::ClockPart(Bus& bus, PowerPart& power, std::function<unsigned()> flash_wait_states)
    : bus_(bus), power_(power), flash_wait_states_(std::move(flash_wait_states)) {
  reset();
}

void ClockPart::reset() {
  control_ = kControlReset;
  pll_ = kPllReset;
  configuration_ = 0;
  status_ = kStatusReset;
  other_ = {{0x30, 0x00100000}};  // AHB1ENR: the CCM's clock
  hsi_ready_at_ = 0.0;
  follow_switch();
}

std::function<bool()> ClockPart::enabled(std::uint32_t register_offset, unsigned number) {
  return [this, register_offset, number] { return bits(other_[register_offset], number) != 0; };
}

void ClockPart::resets(std::uint32_t register_offset, unsigned number, Part& part) {
  resets_.push_back({register_offset, number, &part});
}

double ClockPart::pll_output_Hz(std::uint32_t divider) const {
  const double input = bits(pll_, 22) != 0 ? crystal_Hz : kHsi_Hz;
  return input / bits(pll_, 0, 6) * bits(pll_, 6, 9) / divider;
}

double ClockPart::system_Hz() const {
  switch (bits(configuration_, 2, 2)) {
    case kHse:
      return crystal_Hz;
    case kPll:
      return pll_output_Hz(2 * (bits(pll_, 16, 2) + 1));
    default:
      return kHsi_Hz;
  }
}

double ClockPart::ahb_Hz() const {
  const std::uint32_t field = bits(configuration_, 4, 4);
  if (field < 8) return system_Hz();
  return system_Hz() / (field < 12 ? 2u << (field - 8) : 64u << (field - 12));
}
double ClockPart::apb1_Hz() const { return ahb_Hz() / bus_divider(bits(configuration_, 10, 3)); }
double ClockPart::apb2_Hz() const { return ahb_Hz() / bus_divider(bits(configuration_, 13, 3)); }
/// 7.2: the bus clock if it is not divided, otherwise twice the bus clock.
double ClockPart::apb1_timers_Hz() const {
  return apb1_Hz() * (bus_divider(bits(configuration_, 10, 3)) == 1 ? 1.0 : 2.0);
}
double ClockPart::usb_Hz() const { return pll_output_Hz(bits(pll_, 24, 4)); }

bool ClockPart::source_is_ready(std::uint32_t source) const {
  const std::uint32_t ready = source == kHsi ? kHsiReady : source == kHse ? kHseReady : kPllReady;
  return (control_ & ready) != 0;
}

void ClockPart::run(double now_ns) {
  const auto becomes = [&](std::uint32_t on, std::uint32_t ready, double at) {
    if ((control_ & on) == 0)
      control_ &= ~ready;
    else if (now_ns >= at)
      control_ |= ready;
  };
  becomes(kHsiOn, kHsiReady, hsi_ready_at_);
  if (crystal_works) becomes(kHseOn, kHseReady, hse_ready_at_);
  if ((control_ & kHseOn) == 0) control_ &= ~kHseReady;
  const bool pll_has_input = bits(pll_, 22) == 0 || (control_ & kHseReady) != 0;
  if (pll_has_input || (control_ & kPllOn) == 0) becomes(kPllOn, kPllReady, pll_ready_at_);
  follow_switch();
}

/// 7.3.3: the status follows the switch once its source is ready.
void ClockPart::follow_switch() {
  const std::uint32_t wanted = bits(configuration_, 0, 2);
  if (wanted != bits(configuration_, 2, 2) && source_is_ready(wanted)) {
    configuration_ = (configuration_ & ~0xCu) | wanted << 2;
    // Table 11, 2.7 to 3.6 V: a wait state each 30 MHz; 5.1.4, 7.2: limits of the buses and of the regulator's scales.
    if (ahb_Hz() > 30e6 * (flash_wait_states_() + 1)) bus_.complain("clock: too few wait states of the flash");
    if (ahb_Hz() > 168e6 || apb1_Hz() > 42e6 || apb2_Hz() > 84e6) bus_.complain("clock: a bus is too fast");
    if (ahb_Hz() > 144e6 && !power_.full_speed()) bus_.complain("clock: regulator scale 2 above 144 MHz");
  }
  bus_.set_processor_clock(ahb_Hz());
}

void ClockPart::write_control(std::uint32_t value) {
  const std::uint32_t source = bits(configuration_, 2, 2);
  const bool crystal_is_used = source == kHse || (source == kPll && bits(pll_, 22) != 0);
  const double now = bus_.now_ns();
  const auto starts = [&](std::uint32_t bit) { return (value & bit) != 0 && (control_ & bit) == 0; };
  if (starts(kHsiOn)) hsi_ready_at_ = now + kHsiStart_ns;
  if (starts(kHseOn)) hse_ready_at_ = now + kHseStart_ns;
  if (starts(kPllOn)) {
    pll_ready_at_ = now + kPllLock_ns;
    const double input = (bits(pll_, 22) != 0 ? crystal_Hz : kHsi_Hz) / bits(pll_, 0, 6);
    const double oscillator = input * bits(pll_, 6, 9);
    if (input < 0.95e6 || input > 2.1e6 || oscillator < 100e6 || oscillator > 432e6)
      bus_.complain("clock: the PLL is outside its range");  // 7.3.2; datasheet, table 36
    if (bits(pll_, 22) != 0 && (control_ & kHseReady) == 0) bus_.complain("clock: the PLL has no input yet");
  }
  // 7.3.1: the oscillator that drives the system cannot be switched off.
  if (source == kHsi) value |= kHsiOn;
  if (crystal_is_used) value |= kHseOn;
  if (source == kPll) value |= kPllOn;
  constexpr std::uint32_t kReadOnly = kHsiReady | kHseReady | kPllReady;
  control_ = (value & ~kReadOnly) | (control_ & kReadOnly);
}

std::uint32_t ClockPart::read(std::uint32_t offset) {
  switch (offset) {
    case 0x00:
      return control_;
    case 0x04:
      return pll_;
    case 0x08:
      return configuration_;
    case 0x74:
      return status_;
    default:
      return other_[offset];
  }
}

void ClockPart::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x00:
      write_control(value);
      break;
    case 0x04:
      if ((control_ & kPllOn) != 0) return bus_.complain("clock: PLLCFGR written while the PLL runs: lost");  // 7.3.2
      pll_ = value;
      break;
    case 0x08:
      configuration_ = (value & ~0xCu) | (configuration_ & 0xCu);
      break;
    case 0x74:
      if (bits(value, 24) != 0) status_ &= 0xFFFFFF;  // 7.3.21, RMVF
      break;
    default:
      other_[offset] = value;
      for (const Reset& reset : resets_)
        if (reset.offset == offset && bits(value, reset.bit) != 0) reset.part->reset();
  }
  run(bus_.now_ns());
}

void ClockPart::leave_as_boot_rom() {
  constexpr std::uint32_t kM = 8, kN = 240, kBy4 = 1, kFromCrystal = 1u << 22, kQ = 5;
  pll_ = kM | kN << 6 | kBy4 << 16 | kFromCrystal | kQ << 24;
  control_ = kControlReset | kHsiReady | kHseOn | kHseReady | kPllOn | kPllReady;
  configuration_ = kPll | kPll << 2 | 4u << 10;  // APB1 at half of 60 MHz
  other_[0x34] = 1u << 7;                        // its USB controller
  bus_.set_processor_clock(ahb_Hz());
}

}  // namespace parts
