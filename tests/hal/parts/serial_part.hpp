// A serial port whose characters take their time. RM0090, chapter 30.
#pragma once

#include <functional>
#include <string>

#include "tests/hal/parts/bus.hpp"

namespace parts {

class SerialPart : public Part {
 public:
  /// `baud`: rate of the other end.
  SerialPart(Bus& bus, std::function<double()> clock_Hz, double baud)
      : bus_(bus), clock_Hz_(std::move(clock_Hz)), baud_(baud) {}

  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void run(double now_ns) override;
  void reset() override;

  /// A character of the other end has just arrived completely.
  void type(char character);
  /// Characters that the other end has received; '?' if the rates differ by more than 2 %.
  const std::string& sent() const { return sent_; }
  bool is_idle() const { return !shifts_ && !waits_; }

 private:
  double character_ns() const;

  Bus& bus_;
  std::function<double()> clock_Hz_;
  double baud_;
  std::uint32_t divider_ = 0, control_ = 0, other_[2] = {};
  std::uint32_t arrived_ = 0, waiting_ = 0, shifting_ = 0;
  bool has_arrived_ = false, overrun_ = false, waits_ = false, shifts_ = false;
  double done_at_ns_ = 0.0;
  std::string sent_;
};

}  // namespace parts
