// A general-purpose timer: counter, quadrature decoder, capture, compare, trigger output. RM0090, chapter 18.
#pragma once

#include <functional>

#include "tests/hal/parts/bus.hpp"

namespace parts {

class TimerPart : public Part {
 public:
  /// `width`: 32 bits in TIM2 and TIM5, 16 in TIM3 and TIM4.
  TimerPart(Bus& bus, unsigned width, std::function<double()> clock_Hz);

  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void run(double now_ns) override;
  void reset() override;

  // The encoder's side.
  /// Turns the encoder by this many edges; positive: A leads B.
  void turn(int edges);
  /// The index pulse, at the encoder's present count.
  void index();
  /// Noise on the index line: a spike of this length.
  void index_spike(double length_ns);
  /// An edge on the line of channel 1 that lasts this long.
  void line_edge(bool rises, double lasts_ns = 1e9);
  /// A pulse on one of the trigger inputs ITR0 to ITR3.
  void internal_trigger(unsigned input);
  /// False: the lines end at a pin that does not carry them to this timer.
  std::function<bool()> is_wired = [] { return true; };

  /// Called at each trigger output.
  std::function<void()> on_trigger;
  /// Called at each compare event of a channel, from 0, that requests DMA.
  std::function<void(unsigned)> on_request;

 private:
  void update();
  void capture(unsigned channel);
  void count(bool up);
  void edge(unsigned channel, bool rises, bool other_level);
  double filter_ns(unsigned channel) const;
  bool is_input(unsigned channel) const;
  bool is_output(unsigned channel) const;
  double to_next_compare() const;
  void compare();

  Bus& bus_;
  std::uint32_t most_;
  std::function<double()> clock_Hz_;
  std::uint32_t control_ = 0, control2_ = 0, slave_ = 0, interrupts_ = 0, status_ = 0, enabled_ = 0;
  std::uint32_t mode_[2] = {}, counter_ = 0, prescaler_ = 0, prescaler_now_ = 0, reload_ = 0, capture_[4] = {};
  int quadrature_ = 0;
  double counted_until_ns_ = 0.0;
};

}  // namespace parts
