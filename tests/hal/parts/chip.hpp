// The STM32F405 of the axis board with the connected parts that the drivers use: parts at their addresses (RM0090,
// 2.3), their clock enables and resets (7.3), their wires. `Chip chip;` in a test, and the drivers run.
#pragma once

#include <array>
#include <map>

#include "tests/hal/parts/adc_part.hpp"
#include "tests/hal/parts/bus.hpp"
#include "tests/hal/parts/clock_part.hpp"
#include "tests/hal/parts/converter_part.hpp"
#include "tests/hal/parts/flash_part.hpp"
#include "tests/hal/parts/port_part.hpp"
#include "tests/hal/parts/serial_part.hpp"
#include "tests/hal/parts/spi_part.hpp"
#include "tests/hal/parts/timer_part.hpp"
#include "tests/hal/parts/watchdog_part.hpp"

namespace parts {

class Chip {
 public:
  Chip();

  /// Clocks at 168 MHz and every peripheral's clock on, as if start-up had run: for tests of single drivers.
  void run_at_full_speed();

  /// Advances time, in steps short enough for interrupts to occur on time.
  void pass_ms(double time_ms);

  /// The USB controller has an event to report.
  void usb_event();

  /// The probe's contact at PB6 closes to ground or opens, for this long.
  void probe(bool closed, double lasts_ns = 1e9);

  Bus bus;
  PowerPart power;
  FlashPart flash{bus};
  ClockPart clock{bus, power, [this] { return flash.wait_states(); }};
  PortPart port_a{bus, 'A'}, port_b{bus, 'B'}, port_c{bus, 'C'};
  TimerPart timer2{bus, 32, [this] { return clock.apb1_timers_Hz(); }};
  TimerPart timer3{bus, 16, [this] { return clock.apb1_timers_Hz(); }};
  TimerPart timer4{bus, 16, [this] { return clock.apb1_timers_Hz(); }};
  TimerPart timer5{bus, 32, [this] { return clock.apb1_timers_Hz(); }};
  TimerPart timer13{bus, 16, [this] { return clock.apb1_timers_Hz(); }};
  SpiPart spi{bus, [this] { return clock.apb2_Hz(); }};
  ConverterPart converter{bus};
  DmaPart dma1{bus}, dma2{bus};
  AdcPart adc{bus, dma2, [this] { return clock.apb2_Hz(); }};
  SerialPart serial{bus, [this] { return clock.apb2_Hz(); }, 115200.0};
  IndependentWatchdogPart independent_watchdog{bus};
  WindowWatchdogPart window_watchdog{[this] { return clock.apb1_Hz(); }, clock.enabled(0x40, 11)};
  MemoryAt identifier{0x1FFF7000, 0x1000};  ///< where the unique identifier lies (39.1)
  PlainRegisters usb{0x1000}, interrupts{0x1000}, system{0x100};
  CyclePart cycles{[this] { return clock.ahb_Hz(); }, [this] { return bits(system.read(0xFC), 24) != 0; }};

  /// Handlers of the enabled interrupts, by their numbers (table 62).
  std::map<unsigned, std::function<void()>> handlers;

 private:
  void wire_ports();
  void interrupt(unsigned number);
};

}  // namespace parts
