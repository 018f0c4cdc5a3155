// The periphery of the axis board, and the two axes' hardware interface on it.
#pragma once

#include "firmware/boards/axis-f405/pins.hpp"
#include "firmware/boards/image/fault_handler.hpp"
#include "firmware/boards/image/survival_record.hpp"
#include "hal/ad5752.hpp"
#include "hal/board.hpp"
#include "hal/cortex_m/control_shut_out.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/drive_lines.hpp"
#include "hal/stm32f4/encoder_timer.hpp"
#include "hal/stm32f4/microsecond_clock.hpp"
#include "hal/stm32f4/parameter_flash.hpp"
#include "hal/stm32f4/spi_port.hpp"
#include "hal/stm32f4/supply_detector.hpp"
#include "hal/stm32f4/tachometer_adc.hpp"
#include "hal/stm32f4/usart_port.hpp"
#include "hal/stm32f4/usb_controller.hpp"
#include "hal/stm32f4/watchdog.hpp"
#include "hal/tinyusb/hid_port.hpp"

namespace firmware::boards {

using Converter = hal::Ad5752<hal::stm32f4::SpiPort>;

/// One axis's share of the board.
class BoardAxisHal {
 public:
  BoardAxisHal(hal::stm32f4::Timer& timer, const hal::stm32f4::TachometerSamples& samples, std::uint32_t channel,
               Converter::Channel& dac, const hal::stm32f4::DriveLines& lines,
               const hal::stm32f4::SwitchInputs& switches)
      : encoder_(timer), tachometer_(samples, channel), dac_(dac), lines_(lines), switches_(switches) {}

  void start() {
    lines_.start();
    switches_.start();
    encoder_.start();
  }

  hal::stm32f4::EncoderTimer& encoder() { return encoder_; }
  hal::stm32f4::TachometerChannel& tachometer() { return tachometer_; }
  Converter::Channel& dac() { return dac_; }
  hal::stm32f4::DriveLines& drive_enable() { return lines_; }
  hal::stm32f4::SwitchInputs& limits() { return switches_; }

 private:
  hal::stm32f4::EncoderTimer encoder_;
  hal::stm32f4::TachometerChannel tachometer_;
  Converter::Channel& dac_;
  hal::stm32f4::DriveLines lines_;
  hal::stm32f4::SwitchInputs switches_;
};
static_assert(hal::AxisHal<BoardAxisHal>);

class Board {
 public:
  using AxisType = BoardAxisHal;
  using ControlShutOut = hal::cortex_m::ControlShutOut;

  /// Clocks, pins and peripherals, with the D/A at 0 V and the enables off from the first moment. False when the clock
  /// or the converter does not start; the board must then stay disabled.
  bool start();

  /// Starts the watchdog, which wants food every 50 ms from now on.
  void start_watchdog() { watchdog_.start(kWatchdog_ms); }
  void feed_watchdog() { watchdog_.feed(); }

  /// 250 Hz to 20 kHz; before start_control(), or at any time after.
  void set_control_rate(std::uint32_t rate_Hz);
  /// Converts the tachometers and calls the control interrupt from now on.
  void start_control();
  /// Shows the board to the computer at its other end. False when the controller does not answer.
  bool start_usb();
  /// First thing in the control interrupt.
  void acknowledge_control();

  BoardAxisHal& axis(std::size_t index) { return index == 0 ? x_ : y_; }
  hal::stm32f4::StopInput& emergency_stop() { return stop_; }
  hal::stm32f4::SupplyDetector& supply() { return supply_; }
  hal::stm32f4::MicrosecondClock& clock() { return clock_; }
  hal::stm32f4::UsartPort& serial() { return serial_; }
  hal::tinyusb::HidPort& usb() { return usb_; }
  hal::stm32f4::ParameterFlash& parameter_flash() { return parameter_flash_; }

  /// Erasing a sector takes 2 s at most (datasheet, table 40); the watchdog's oscillator runs at 47 kHz instead of 32
  /// at most, which makes 4 s 2.7.
  void begin_stall() { watchdog_.allow(4000); }
  void end_stall() { watchdog_.allow(kWatchdog_ms); }
  void restart() { reset_processor(); }

  void show(bool running, bool fault);

 private:
  static constexpr std::uint32_t kWatchdog_ms = 50;

  hal::stm32f4::TachometerSamples samples_{};
  hal::stm32f4::SpiPort spi_{hal::stm32f4::spi1(), pins::dac_select()};
  Converter converter_{spi_};
  BoardAxisHal x_{hal::stm32f4::timer2(),
                  samples_,
                  0,
                  converter_.a(),
                  {pins::enable_x(), pins::drive_fault_x()},
                  {pins::positive_end_x(), pins::negative_end_x(), pins::home_x()}};
  BoardAxisHal y_{hal::stm32f4::timer5(),
                  samples_,
                  1,
                  converter_.b(),
                  {pins::enable_y(), pins::drive_fault_y()},
                  {pins::positive_end_y(), pins::negative_end_y(), pins::home_y()}};
  hal::stm32f4::StopInput stop_{pins::emergency_stop()};
  hal::stm32f4::SupplyDetector supply_{hal::stm32f4::power()};
  hal::stm32f4::MicrosecondClock clock_{hal::stm32f4::timer4()};
  hal::stm32f4::UsartPort serial_{hal::stm32f4::usart1()};
  hal::tinyusb::HidPort usb_;
  hal::stm32f4::ParameterFlash parameter_flash_{
      hal::stm32f4::flash_interface(), reinterpret_cast<std::byte*>(hal::stm32f4::ParameterFlash::kFirstAddress)};
  hal::stm32f4::Watchdog watchdog_{hal::stm32f4::independent_watchdog()};
};

static_assert(hal::Board<Board>);

/// What the chip's reset flags say (RM0090, 7.3.21); clears them.
ResetCause read_reset_cause();

}  // namespace firmware::boards
