// A serial peripheral interface as master, bit by bit. RM0090, chapter 28.
#pragma once

#include <functional>

#include "tests/hal/parts/bus.hpp"

namespace parts {

/// A part at the other end of the serial lines. `at_ns`: time of an edge.
class SerialSlave {
 public:
  virtual ~SerialSlave() = default;
  virtual void data_line(bool level, double at_ns) = 0;
  virtual void clock_line(bool level, double at_ns) = 0;
  /// Level of the line to the master at that time.
  virtual bool answer_line(double at_ns) = 0;
};

class SpiPart : public Part {
 public:
  SpiPart(Bus& bus, std::function<double()> clock_Hz) : bus_(bus), clock_Hz_(std::move(clock_Hz)) {}

  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void run(double now_ns) override;
  void reset() override;

  SerialSlave* slave = nullptr;
  /// False: the lines do not reach the slave, because a pin does not carry them.
  std::function<bool()> is_wired;
  bool is_dead = false;  ///< the shift register never ends

 private:
  bool master() const;
  void begin(std::uint32_t byte, double at_ns);
  void half_bit(double at_ns);
  void clock_line(bool level, double at_ns);

  Bus& bus_;
  std::function<double()> clock_Hz_;
  std::uint32_t control_ = 0, control2_ = 0;
  std::uint32_t shifting_ = 0, received_ = 0, arrived_ = 0, waiting_ = 0;
  int half_bits_left_ = 0;
  double next_edge_ns_ = 0.0;
  bool has_arrived_ = false, has_waiting_ = false, overrun_ = false;
  bool clock_level_ = false;
};

}  // namespace parts
