#include "tests/hal/parts/chip.hpp"

namespace parts {

namespace {

enum : std::uint32_t { kAhb1Reset = 0x10, kAhb2Reset = 0x14, kApb1Reset = 0x20, kApb2Reset = 0x24 };
enum : std::uint32_t { kAhb1Enable = 0x30, kAhb2Enable = 0x34, kApb1Enable = 0x40, kApb2Enable = 0x44 };
constexpr unsigned kAdcInterrupt = 18, kDma2Stream0Interrupt = 56, kUsbInterrupt = 67;
constexpr int kSpi1 = 5, kTimer2 = 1, kTimer4 = 2, kTimer5 = 2;  // alternate functions: datasheet, table 9

}  // namespace

Chip::Chip() {
  bus.attach(0x40023800, 0x90, clock);
  bus.attach(0x40007000, 0x08, power, clock.enabled(kApb1Enable, 28));
  bus.attach(0x40023C00, 0x18, flash);
  bus.attach(0x40003000, 0x10, independent_watchdog);
  bus.attach(0x40002C00, 0x0C, window_watchdog);
  bus.attach(0xE000E010, 0xCF0, interrupts);  // SysTick, interrupt controller
  bus.attach(0xE000ED00, 0x100, system);      // system control block, DEMCR
  bus.attach(0xE0001000, 0x1000, cycles);
  const auto attach = [this](std::uintptr_t base, std::uint32_t size, Part& part, std::uint32_t enable,
                             std::uint32_t reset, unsigned bit) {
    bus.attach(base, size, part, clock.enabled(enable, bit));
    clock.resets(reset, bit, part);
  };
  attach(0x40020000, 0x28, port_a, kAhb1Enable, kAhb1Reset, 0);
  attach(0x40020400, 0x28, port_b, kAhb1Enable, kAhb1Reset, 1);
  attach(0x40020800, 0x28, port_c, kAhb1Enable, kAhb1Reset, 2);
  attach(0x40026000, 0xD0, dma1, kAhb1Enable, kAhb1Reset, 21);
  attach(0x40026400, 0xD0, dma2, kAhb1Enable, kAhb1Reset, 22);
  attach(0x50000000, 0x1000, usb, kAhb2Enable, kAhb2Reset, 7);
  attach(0x40000000, 0x50, timer2, kApb1Enable, kApb1Reset, 0);
  attach(0x40000400, 0x50, timer3, kApb1Enable, kApb1Reset, 1);
  attach(0x40000800, 0x50, timer4, kApb1Enable, kApb1Reset, 2);
  attach(0x40000C00, 0x50, timer5, kApb1Enable, kApb1Reset, 3);
  attach(0x40001C00, 0x50, timer13, kApb1Enable, kApb1Reset, 7);
  attach(0x40011000, 0x1C, serial, kApb2Enable, kApb2Reset, 4);
  attach(0x40012000, 0x400, adc, kApb2Enable, kApb2Reset, 8);
  attach(0x40013000, 0x24, spi, kApb2Enable, kApb2Reset, 12);
  clock.resets(kApb1Reset, 11, window_watchdog);

  spi.slave = &converter;
  timer3.on_trigger = [this] { adc.trigger_timer3(); };
  timer3.on_request = [this](unsigned channel) {  // 10.3.3, table 42: TIM3_CH1 and CH2 on streams 4 and 5
    if (channel < 2) dma1.request_word(4 + channel, 5);
  };
  dma2.on_complete = [this](unsigned stream) {
    if (stream == 0) interrupt(kDma2Stream0Interrupt);
  };
  adc.on_interrupt = [this] { interrupt(kAdcInterrupt); };
  wire_ports();
}

void Chip::wire_ports() {
  // The converter: PA4 selects, PA5 clocks, PA6 brings back, PA7 sends, PB0 clears.
  spi.is_wired = [this] {
    return port_a.function(5) == kSpi1 && port_a.function(6) == kSpi1 && port_a.function(7) == kSpi1;
  };
  port_a.on_change[4] = [this](Drive drive) {
    const bool drives = drive == Drive::low || drive == Drive::high;
    if (drives && port_a.edge_ns(4) > 20.0) bus.complain("converter: SYNC's edge is slower than a frame's times");
    converter.select_line(drive != Drive::low);
  };
  port_b.on_change[0] = [this](Drive drive) { converter.clear_line(drive == Drive::high); };  // pulled down outside
  converter.clear_line(false);
  timer2.is_wired = [this] {
    return port_a.function(15) == kTimer2 && port_b.function(3) == kTimer2 && port_b.function(10) == kTimer2;
  };
  timer5.is_wired = [this] {
    return port_a.function(0) == kTimer5 && port_a.function(1) == kTimer5 && port_a.function(2) == kTimer5;
  };
  timer4.is_wired = [this] { return port_b.function(6) == kTimer4; };
  timer4.on_trigger = [this] {  // 18.4.3: TIM4 is ITR3 of TIM2, ITR2 of TIM5
    timer2.internal_trigger(3);
    timer5.internal_trigger(2);
  };
  adc.is_wired = [this](unsigned channel) { return channel >= 10 && port_c.is_analogue(channel - 10); };
}

void Chip::usb_event() { interrupt(kUsbInterrupt); }

void Chip::probe(bool closed, double lasts_ns) {
  port_b.put(6, closed ? Outside::low : Outside::open);
  timer4.line_edge(!closed, lasts_ns);
}

/// ARMv7-M ARM, B3.4.4: ISER; an interrupt that is not enabled stays pending.
void Chip::interrupt(unsigned number) {
  const std::uint32_t enabled = interrupts.read(0xF0 + number / 32 * 4);
  if (bits(enabled, number % 32) == 0) return;
  if (const auto handler = handlers.find(number); handler != handlers.end()) bus.interrupt(number, handler->second);
}

void Chip::run_at_full_speed() {
  clock.write(kAhb1Enable, 0x00700007);
  clock.write(kAhb2Enable, 0x00000080);
  clock.write(kApb1Enable, 0x1000088F);
  clock.write(kApb2Enable, 0x00001110);
  flash.write(0x00, 5);
  clock.write(0x00, 0x00010083);
  pass_ms(3.0);
  clock.write(0x04, 8u | 336u << 6 | 1u << 22 | 7u << 24);
  clock.write(0x00, 0x01010083);
  pass_ms(1.0);
  clock.write(0x08, 5u << 10 | 4u << 13 | 2u);
  pass_ms(0.01);
}

void Chip::pass_ms(double time_ms) {
  constexpr double kStep_ns = 2000;
  for (double left = 1e6 * time_ms; left > 0.0; left -= kStep_ns) bus.pass_ns(kStep_ns);
}

}  // namespace parts
