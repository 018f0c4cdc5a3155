// Reset and clock control with its oscillators, and power control. RM0090, chapters 5 and 7.
#pragma once

#include <array>
#include <functional>
#include <map>

#include "tests/hal/parts/bus.hpp"

namespace parts {

class PowerPart : public Part {
 public:
  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override { control_ = 0x4000; }  // 5.4.1: regulator scale 1

  bool full_speed() const { return bits(control_, 14) != 0; }
  double supply_V = 3.3;

 private:
  std::uint32_t control_ = 0x4000;
};

class ClockPart : public Part {
 public:
  ClockPart(Bus& bus, PowerPart& power, std::function<unsigned()> flash_wait_states);

  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void run(double now_ns) override;
  void reset() override;

  /// Bit `number` of an enable register (offset 0x30 AHB1, 0x34 AHB2, 0x40 APB1, 0x44 APB2).
  std::function<bool()> enabled(std::uint32_t register_offset, unsigned number);
  /// `part` is reset by a one in bit `number` of a reset register (offset 0x10 AHB1 ... 0x24 APB2).
  void resets(std::uint32_t register_offset, unsigned number, Part& part);

  double system_Hz() const;
  double ahb_Hz() const;
  double apb1_Hz() const;
  double apb2_Hz() const;
  double apb1_timers_Hz() const;
  double usb_Hz() const;
  bool watches_crystal() const { return bits(control_, 19) != 0; }

  bool crystal_works = true;
  double crystal_Hz = 8e6;

  /// As the ROM's USB loader leaves it when it starts the program (AN2606: crystal, PLL, 60 MHz; AN3156: no reset in
  /// between), flash with wait states for it, and its peripherals clocked.
  void leave_as_boot_rom();
  /// The flags that give the cause of the reset (7.3.21).
  void set_reset_flags(std::uint32_t flags) { status_ = (status_ & 0xFFFFFF) | flags; }

 private:
  double pll_output_Hz(std::uint32_t divider) const;
  bool source_is_ready(std::uint32_t source) const;
  void write_control(std::uint32_t value);
  void follow_switch();

  Bus& bus_;
  PowerPart& power_;
  std::function<unsigned()> flash_wait_states_;
  std::uint32_t control_ = 0, pll_ = 0, configuration_ = 0, status_ = 0;
  double hsi_ready_at_ = 0.0, hse_ready_at_ = 0.0, pll_ready_at_ = 0.0;
  std::map<std::uint32_t, std::uint32_t> other_;
  struct Reset {
    std::uint32_t offset;
    unsigned bit;
    Part* part;
  };
  std::vector<Reset> resets_;
};

}  // namespace parts
