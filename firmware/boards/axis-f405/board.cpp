#include "firmware/boards/axis-f405/board.hpp"

#include "firmware/boards/image/fault_handler.hpp"

namespace firmware::boards {

using namespace hal::stm32f4;  // NOLINT(google-build-using-namespace): this file is for one chip

namespace {

// Alternate functions: STM32F405 datasheet, table 9.
constexpr std::uint32_t kTimer2Function = 1, kTimer4Function = 2, kTimer5Function = 2, kSpi1Function = 5,
                        kUsart1Function = 7, kUsbFunction = 10;

/// Brown-out reset, which is off until the chip's option bytes are written (front-end.md).
constexpr std::uint32_t kBrownOutWanted = 270;

constexpr const char* name_of(hal::ConverterState state) {
  switch (state) {
    case hal::ConverterState::sound:
      return "sound";
    case hal::ConverterState::silent:
      return "silent";
    case hal::ConverterState::registers_differ:
      return "not as it was set";
    case hal::ConverterState::too_hot:
      return "too hot";
    case hal::ConverterState::overloaded:
      break;
  }
  return "overloaded";
}

void connect_pins() {
  pins::dac_not_clear().make_output(false);  // sets the converter's outputs to 0 V, whatever its registers hold
  for (const Pin& pin : {pins::enable_x(), pins::enable_y(), pins::brake_x(), pins::brake_y()}) pin.make_output(false);
  for (const Pin& pin : {pins::encoder_x_a(), pins::encoder_x_b(), pins::encoder_x_index()})
    pin.make_alternate(kTimer2Function, Pull::up);
  for (const Pin& pin : {pins::encoder_y_a(), pins::encoder_y_b(), pins::encoder_y_index()})
    pin.make_alternate(kTimer5Function, Pull::up);
  pins::probe().make_alternate(kTimer4Function, Pull::up);
  for (const Pin& pin : {pins::dac_clock(), pins::dac_data_in(), pins::dac_data_out()})
    pin.make_alternate(kSpi1Function);
  pins::serial_out().make_alternate(kUsart1Function);
  pins::serial_in().make_alternate(kUsart1Function, Pull::up);
  pins::usb_minus().make_alternate(kUsbFunction);
  pins::usb_plus().make_alternate(kUsbFunction);
  pins::tachometer_x().make_analogue();
  pins::tachometer_y().make_analogue();
  pins::led_running().make_output(false);
  pins::led_fault().make_output(false);
}

}  // namespace

#ifndef AXIS_REGISTERS_ANSWERED
static_assert(AXIS_CONTROL_INTERRUPT == kDma2Stream0Interrupt && AXIS_ADC_INTERRUPT == kAdcInterrupt &&
                  AXIS_USB_INTERRUPT == kOtgFsInterrupt,
              "the vector table has these elsewhere than the chip");
#endif

bool Board::start() {
  Rcc& clock = rcc();
  const bool clocks_reset = reset_clocks(clock);
  clock.AHB1ENR = clock.AHB1ENR | Rcc::kGpioA | Rcc::kGpioB | Rcc::kGpioC | Rcc::kDma1 | Rcc::kDma2;
  connect_pins();
  const bool clocks_run = clocks_reset && start_clocks(clock, power(), flash_interface());
  clock.APB1ENR = clock.APB1ENR | Rcc::kTim2 | Rcc::kTim3 | Rcc::kTim4 | Rcc::kTim5 | Rcc::kTim13;
  clock.APB2ENR = clock.APB2ENR | Rcc::kUsart1 | Rcc::kAdc1 | Rcc::kSpi1;
  usart_.start(clocks_run ? kApb2Clock_Hz : kResetClock_Hz, 115200);
  stop_.start();
  power_relay_.start();
  supply_.start();
  vbus_.start();
  pump_.start();
  clock_.start(kApb1TimerClock_Hz);
  probe_.start();
  x_.start();
  y_.start();
  spi_.start();
  pin_modes_.remember();
  pins::dac_not_clear().set(true);
  const bool converter_answers = converter_.start();
  return clocks_run && converter_answers;
}

void Board::set_control_rate(std::uint32_t rate_Hz) {
  control_rate_Hz_ = rate_Hz;
  period_us_ = 1'000'000 / rate_Hz;
  control_timer_.set_rate(rate_Hz);
}

void Board::start_control() {
  constexpr std::uint8_t kPriority = 1;
  scan_.start();
  hal::cortex_m::enable_interrupt(kAdcInterrupt, kPriority);
  hal::cortex_m::enable_interrupt(kDma2Stream0Interrupt, kPriority);
  control_timer_.start(kApb1TimerClock_Hz, control_rate_Hz_);
}

void Board::start_watchdogs() {
  Rcc& clock = rcc();
  clock.APB1ENR = clock.APB1ENR | Rcc::kWindowWatchdog;
  watchdog_.start(kWatchdog_ms);
  const ControlShutOut guard;
  period_watchdog_.start();
}

/// Without its clock the window watchdog of this chip stands still (RM0090, 7.3.13: set and cleared by software). The
/// independent watchdog cannot be stopped.
void Board::begin_stall() {
  rcc().APB1ENR = rcc().APB1ENR & ~Rcc::kWindowWatchdog;
  watchdog_.allow(kStall_ms);
}

void Board::end_stall() {
  watchdog_.allow(kWatchdog_ms);
  rcc().APB1ENR = rcc().APB1ENR | Rcc::kWindowWatchdog;
}

void Board::watch(bool outputs_off) {
  const std::uint32_t now_periods = control_periods_;
  usb_.attach(vbus_.is_present(now_periods, control_rate_Hz_ / 10));  // 100 ms
  if (now_periods - watched_at_period_ < control_rate_Hz_ / kWatches_Hz) return;
  watched_at_period_ = now_periods;
  const ControlShutOut guard;  // 9 us: two frames of the converter that must not be interrupted
  if (converter_.state() == hal::ConverterState::sound) {
    converter_.watch();
    if (converter_.state() != hal::ConverterState::sound) converter_trouble_ = converter_.state();
  } else if (outputs_off) {
    converter_.start();
  }
}

bool Board::lacks_brown_out_reset() const { return brown_out_threshold(flash_interface()) != kBrownOutWanted; }

void Board::report(TextWriter<Serial>& out) const {
  const std::uint32_t threshold = brown_out_threshold(flash_interface());
  out << "option bytes: brown-out reset ";
  if (threshold == 0)
    out << "off";
  else
    out << "at " << threshold << " hundredths of a volt";
  out << (lacks_brown_out_reset() ? ", must be 270: see front-end.md\n" : "\n");
  out << "converter: " << name_of(converter_.state()) << ", last trouble: " << name_of(converter_trouble_)
      << "; scans restarted after an overrun: " << scan_.overruns() << "; characters lost here: " << serial_.lost()
      << "\n";
}

bool Board::start_usb() {
  constexpr std::uint8_t kPriority = 6;
  power_usb_controller(rcc(), otg_fs_global());
  hal::cortex_m::set_interrupt_priority(kOtgFsInterrupt, kPriority);
  const auto serial_number = serial_number_text(unique_identifier());
  return usb_.start({serial_number.data(), serial_number.size()});
}

void Board::acknowledge_control() {
  control_periods_ = control_periods_ + 1;
  scan_.acknowledge();
  x_.tachometer().conversions_have_arrived();
  y_.tachometer().conversions_have_arrived();
}

void Board::control_has_run(bool all_is_alive) {
  if (all_is_alive) pump_.beat();
  period_watchdog_.period_passed(period_us_);
}

void Board::show(bool running, bool fault) {
  pins::led_running().set(running);
  pins::led_fault().set(fault);
}

ResetCause read_reset_cause() {
  Rcc& clock = rcc();
  const std::uint32_t flags = clock.CSR;
  clock.CSR = flags | Rcc::kRemoveResetFlags;
  if ((flags & Rcc::kPowerReset) != 0) return ResetCause::power_on;
  if ((flags & Rcc::kBrownOutReset) != 0) return ResetCause::brown_out;
  if ((flags & (Rcc::kWatchdogReset | Rcc::kWindowReset)) != 0) return ResetCause::watchdog;
  if ((flags & Rcc::kSoftwareReset) != 0) return ResetCause::software;
  return (flags & Rcc::kPinReset) != 0 ? ResetCause::reset_pin : ResetCause::unknown;
}

/// Sets only pins: the enables, the brakes, the amplifiers' power, and the converter's clear input, which needs no
/// transfer.
void make_outputs_safe() noexcept {
  for (const Pin& pin : {pins::enable_x(), pins::enable_y(), pins::brake_x(), pins::brake_y(), pins::dynamic_brake_x(),
                         pins::dynamic_brake_y(), pins::power_relay()})
    pin.set(false);
  pins::dac_not_clear().set(false);
  pins::led_fault().set(true);
}

}  // namespace firmware::boards
