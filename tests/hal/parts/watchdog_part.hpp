// The two watchdogs. RM0090, chapters 21 and 22. Both end in ChipReset.
#pragma once

#include <functional>

#include "tests/hal/parts/bus.hpp"

namespace parts {

class IndependentWatchdogPart : public Part {
 public:
  explicit IndependentWatchdogPart(Bus& bus) : bus_(bus) {}

  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void run(double now_ns) override;
  void reset() override;

  double oscillator_Hz = 32e3;  ///< 17 to 47 kHz (datasheet, table 35)
  bool is_running() const { return runs_; }
  double timeout_ns() const { return 1e9 * (4u << prescaler_) * (reload_ + 1) / oscillator_Hz; }

 private:
  double update_ns() const { return 5e9 / oscillator_Hz; }  // 21.4.4: up to five cycles

  Bus& bus_;
  std::uint32_t prescaler_ = 0, reload_ = 0xFFF;
  bool runs_ = false, unlocked_ = false;
  double prescaler_ready_ns_ = 0.0, reload_ready_ns_ = 0.0, fed_at_ns_ = 0.0, fed_for_ns_ = 0.0;
};

class WindowWatchdogPart : public Part {
 public:
  WindowWatchdogPart(std::function<double()> clock_Hz, std::function<bool()> is_clocked)
      : clock_Hz_(std::move(clock_Hz)), is_clocked_(std::move(is_clocked)) {}

  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void run(double now_ns) override;
  void reset() override;

  bool is_running() const { return bits(control_, 7) != 0; }

 private:
  std::function<double()> clock_Hz_;
  std::function<bool()> is_clocked_;
  std::uint32_t control_ = 0x7F, configuration_ = 0x7F;
  double ran_until_ns_ = 0.0, phase_ns_ = 0.0;
};

}  // namespace parts
