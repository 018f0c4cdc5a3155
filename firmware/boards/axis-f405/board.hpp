// The peripherals of the axis board, and the hardware interface of its two axes.
#pragma once

#include "firmware/boards/axis-f405/pins.hpp"
#include "firmware/boards/image/capture_memory.hpp"
#include "firmware/boards/image/fault_handler.hpp"
#include "firmware/boards/image/survival_record.hpp"
#include "firmware/boards/image/text_writer.hpp"
#include "hal/ad5752.hpp"
#include "hal/board.hpp"
#include "hal/cortex_m/control_shut_out.hpp"
#include "hal/serial_queue.hpp"
#include "hal/stm32f4/charge_pump.hpp"
#include "hal/stm32f4/chip_flash.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/control_timer.hpp"
#include "hal/stm32f4/drive_lines.hpp"
#include "hal/stm32f4/encoder_timer.hpp"
#include "hal/stm32f4/microsecond_clock.hpp"
#include "hal/stm32f4/option_bytes.hpp"
#include "hal/stm32f4/pin_modes.hpp"
#include "hal/stm32f4/probe_timer.hpp"
#include "hal/stm32f4/spi_port.hpp"
#include "hal/stm32f4/supply_detector.hpp"
#include "hal/stm32f4/tachometer_adc.hpp"
#include "hal/stm32f4/usart_port.hpp"
#include "hal/stm32f4/usb_controller.hpp"
#include "hal/stm32f4/watchdog.hpp"
#include "hal/tinyusb/hid_port.hpp"

namespace firmware::boards {

using Converter = hal::Ad5752<hal::stm32f4::SpiPort>;

/// The board's hardware for one axis. A sensor with a concept of its own in `core` is a further member: add it here, in
/// the constructor, to the accessors, and to both wirings below.
class BoardAxisHal {
 public:
  struct Wiring {
    hal::stm32f4::Timer& encoder;
    std::uint32_t probe_trigger;     ///< as for EncoderTimer
    hal::stm32f4::DmaStream& latch;  ///< likewise
    hal::stm32f4::Pin encoder_fault;
    const hal::stm32f4::TachometerSamples& samples;
    std::uint32_t tachometer_channel;
    Converter::Channel& dac;
    hal::stm32f4::DriveLines::Pins lines;
    hal::stm32f4::SwitchInputs::Pins switches;
  };
  explicit BoardAxisHal(const Wiring& w)
      : encoder_(w.encoder, w.probe_trigger, w.latch, w.encoder_fault),
        tachometer_(w.samples, w.tachometer_channel),
        dac_(w.dac),
        lines_(w.lines),
        switches_(w.switches) {}

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
  static constexpr std::size_t kAxes = hal::kAxisCount;
  static constexpr bool kIsSimulated = false;
  using AxisType = BoardAxisHal;
  using ControlShutOut = hal::cortex_m::ControlShutOut;

  using Serial = hal::SerialQueue<hal::stm32f4::UsartPort, 2048>;  ///< room for a boot report with a fault

  /// Clocks, pins and peripherals, with the D/A at 0 V and the enables off from the first moment. False when the clock
  /// or the converter does not start; the board must then stay disabled.
  bool start();

  /// Starts the watchdogs. From now on the background must feed one every 50 ms, and the control interrupt the other at
  /// its rate.
  void start_watchdogs();
  void feed_watchdog() { watchdog_.feed(); }

  /// 250 Hz to 20 kHz; before start_control(), or at any time after.
  void set_control_rate(std::uint32_t rate_Hz);
  /// Starts the conversion of the tachometers and the control interrupt.
  void start_control();
  /// Connects the board to USB. False if the controller does not answer.
  bool start_usb();
  /// Call it first in the control interrupt.
  void acknowledge_control();
  /// Call it last in the control interrupt. Drives the external charge pump only while the program works.
  void control_has_run(bool all_is_alive);
  /// The converter's interrupt.
  void recover_conversions() { scan_.recover_from_overrun(); }

  /// Work of the background: connects to a computer if one is present, reads the D/A converter back, one register at a
  /// time, and restarts it while the outputs are off.
  void watch(bool outputs_off);
  /// Whether the pins still have the modes that start() set.
  bool are_pins_kept() const { return pin_modes_.are_kept(); }
  /// Whether the brown-out reset is off, as on a new chip. Then the chip may do anything while its supply falls below
  /// 2.7 V, even erase its flash.
  bool lacks_brown_out_reset() const;
  /// Report for commissioning: option bytes, converter, overruns.
  void report(TextWriter<Serial>& out) const;

  BoardAxisHal& axis(std::size_t index) { return index == 0 ? x_ : y_; }
  hal::stm32f4::StopInput& emergency_stop() { return stop_; }
  hal::stm32f4::RelayOutput& power_relay() { return power_relay_; }
  hal::stm32f4::ProbeTimer& probe() { return probe_; }
  hal::stm32f4::SupplyDetector& supply() { return supply_; }
  hal::stm32f4::MicrosecondClock& clock() { return clock_; }
  static constexpr std::uint32_t processor_Hz() { return hal::stm32f4::kSystemClock_Hz; }
  Serial& serial() { return serial_; }
  hal::tinyusb::HidPort& usb() { return usb_; }
  hal::stm32f4::ParameterFlash& parameter_flash() { return parameter_flash_; }
  hal::stm32f4::ImageFlash& image_flash() { return image_flash_; }
  /// State of the triggered capture; survives a reset.
  TriggeredState& capture_state() { return boards::capture_state(); }
  std::span<std::uint16_t> capture_rows() { return boards::capture_rows(); }

  void begin_stall();
  void end_stall();
  void restart() { reset_processor(); }

  void show(bool running, bool fault);

 private:
  static constexpr std::uint32_t kWatchdog_ms = 50;
  /// Erasing a sector takes at most 2 s (datasheet, table 40). The watchdog's oscillator runs at 47 kHz at most instead
  /// of 32 kHz, so 4 s are at least 2.7 s.
  static constexpr std::uint32_t kStall_ms = 4000;
  static constexpr std::uint32_t kWatches_Hz = 200;  ///< each of the converter's six registers every 30 ms

  hal::stm32f4::TachometerSamples samples_{};
  hal::stm32f4::SpiPort spi_{hal::stm32f4::spi1(), pins::dac_select()};
  Converter converter_{spi_};
  BoardAxisHal x_{
      {.encoder = hal::stm32f4::timer2(),
       .probe_trigger = 3,
       .latch = hal::stm32f4::dma1().stream[4],
       .encoder_fault = pins::encoder_x_fault(),
       .samples = samples_,
       .tachometer_channel = 0,
       .dac = converter_.a(),
       .lines = {.enable = pins::enable_x(),
                 .fault = pins::drive_fault_x(),
                 .ready = pins::drive_ready_x(),
                 .brake = pins::brake_x(),
                 .dynamic_brake = pins::dynamic_brake_x()},
       .switches = {
           .positive_end = pins::positive_end_x(), .negative_end = pins::negative_end_x(), .home = pins::home_x()}}};
  BoardAxisHal y_{
      {.encoder = hal::stm32f4::timer5(),
       .probe_trigger = 2,
       .latch = hal::stm32f4::dma1().stream[5],
       .encoder_fault = pins::encoder_y_fault(),
       .samples = samples_,
       .tachometer_channel = 1,
       .dac = converter_.b(),
       .lines = {.enable = pins::enable_y(),
                 .fault = pins::drive_fault_y(),
                 .ready = pins::drive_ready_y(),
                 .brake = pins::brake_y(),
                 .dynamic_brake = pins::dynamic_brake_y()},
       .switches = {
           .positive_end = pins::positive_end_y(), .negative_end = pins::negative_end_y(), .home = pins::home_y()}}};
  hal::stm32f4::StopInput stop_{pins::emergency_stop()};
  hal::stm32f4::RelayOutput power_relay_{pins::power_relay()};
  hal::stm32f4::SupplyDetector supply_{hal::stm32f4::power()};
  hal::stm32f4::MicrosecondClock clock_{hal::stm32f4::timer13()};
  hal::stm32f4::ProbeTimer probe_{hal::stm32f4::timer4(), pins::probe()};  ///< trigger input of timers 2 and 5
  hal::stm32f4::PinModes pin_modes_;
  hal::stm32f4::VbusInput vbus_{pins::usb_supply()};
  hal::stm32f4::ChargePump pump_{pins::charge_pump()};
  hal::stm32f4::ControlTimer control_timer_{hal::stm32f4::timer3()};
  hal::stm32f4::TachometerScan scan_{hal::stm32f4::adc1(), hal::stm32f4::adc_common_control(), hal::stm32f4::dma2(),
                                     samples_};
  hal::stm32f4::UsartPort usart_{hal::stm32f4::usart1()};
  Serial serial_{usart_};
  hal::tinyusb::HidPort usb_;
  hal::stm32f4::ParameterFlash parameter_flash_{
      hal::stm32f4::flash_interface(), reinterpret_cast<std::byte*>(hal::stm32f4::ParameterFlash::kFirstAddress)};
  hal::stm32f4::ImageFlash image_flash_{hal::stm32f4::flash_interface(),
                                        reinterpret_cast<std::byte*>(hal::stm32f4::ImageFlash::kFirstAddress)};
  hal::stm32f4::Watchdog watchdog_{hal::stm32f4::independent_watchdog()};
  hal::stm32f4::PeriodWatchdog period_watchdog_{hal::stm32f4::window_watchdog()};
  std::uint32_t control_rate_Hz_ = 1000, period_us_ = 1000;
  volatile std::uint32_t control_periods_ = 0;  // written in the interrupt, read in the background
  std::uint32_t watched_at_period_ = 0;
  hal::ConverterState converter_trouble_ = hal::ConverterState::sound;
};

static_assert(hal::Board<Board>);

/// Reads and clears the chip's reset flags (RM0090, 7.3.21).
ResetCause read_reset_cause();

}  // namespace firmware::boards
