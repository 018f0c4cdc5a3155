#include "firmware/boards/axis-f405/board.hpp"

#include "firmware/boards/image/fault_handler.hpp"

namespace firmware::boards {

using namespace hal::stm32f4;  // NOLINT(google-build-using-namespace): this file is the chip's

namespace {

// Alternate functions: STM32F405 datasheet, table 9.
constexpr std::uint32_t kTimer2Function = 1, kTimer5Function = 2, kSpi1Function = 5, kUsart1Function = 7,
                        kUsbFunction = 10;

constexpr std::uint32_t kControlPrescaler = 8;  // 10.5 MHz: 250 Hz still fit 16 bits

void connect_pins() {
  pins::dac_not_clear().make_output(false);  // the converter's own way to 0 V, whatever it holds
  pins::enable_x().make_output(false);
  pins::enable_y().make_output(false);
  for (const Pin& pin : {pins::encoder_x_a(), pins::encoder_x_b(), pins::encoder_x_index()})
    pin.make_alternate(kTimer2Function, Pull::up);
  for (const Pin& pin : {pins::encoder_y_a(), pins::encoder_y_b(), pins::encoder_y_index()})
    pin.make_alternate(kTimer5Function, Pull::up);
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

bool Board::start() {
  Rcc& clock = rcc();
  clock.AHB1ENR = clock.AHB1ENR | Rcc::kGpioA | Rcc::kGpioB | Rcc::kGpioC | Rcc::kDma2;
  connect_pins();
  const bool clocks_run = start_clocks(clock, power(), flash_interface());
  clock.APB1ENR = clock.APB1ENR | Rcc::kTim2 | Rcc::kTim3 | Rcc::kTim4 | Rcc::kTim5;
  clock.APB2ENR = clock.APB2ENR | Rcc::kUsart1 | Rcc::kAdc1 | Rcc::kSpi1;
  constexpr std::uint32_t kResetClock_Hz = 16'000'000;
  serial_.start(clocks_run ? kApb2Clock_Hz : kResetClock_Hz, 115200);
  stop_.start();
  supply_.start();
  clock_.start(kApb1TimerClock_Hz);
  x_.start();
  y_.start();
  spi_.start();
  pins::dac_not_clear().set(true);
  const bool converter_answers = converter_.start();
  return clocks_run && converter_answers;
}

void Board::set_control_rate(std::uint32_t rate_Hz) {
  timer3().ARR = kApb1TimerClock_Hz / kControlPrescaler / rate_Hz - 1;
  timer3().EGR = Timer::kUpdate;  // a count beyond the new end would run on to 65535
}

void Board::start_control() {
  constexpr std::uint8_t kPriority = 1;
  start_tachometer_conversions(adc1(), adc_common_control(), dma2(), samples_);
  hal::cortex_m::enable_interrupt(kDma2Stream0Interrupt, kPriority);
  Timer& timer = timer3();
  timer.PSC = kControlPrescaler - 1;
  timer.CR2 = Timer::kTriggerOnUpdate;
  timer.EGR = Timer::kUpdate;
  timer.CR1 = Timer::kEnable;
}

bool Board::start_usb() {
  constexpr std::uint8_t kPriority = 6;
  power_usb_controller(rcc(), otg_fs_global());
  hal::cortex_m::set_interrupt_priority(kOtgFsInterrupt, kPriority);
  const auto serial_number = serial_number_text(unique_identifier());
  return usb_.start({serial_number.data(), serial_number.size()});
}

void Board::acknowledge_control() {
  dma2().LIFCR = Dma::kStream0All;
  x_.tachometer().conversions_have_arrived();
  y_.tachometer().conversions_have_arrived();
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

/// Pins alone: the enables, and the converter's clear input, which needs no transfer.
void make_outputs_safe() noexcept {
  pins::enable_x().set(false);
  pins::enable_y().set(false);
  pins::dac_not_clear().set(false);
  pins::led_fault().set(true);
}

}  // namespace firmware::boards
