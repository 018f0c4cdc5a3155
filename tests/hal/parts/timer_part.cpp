#include "tests/hal/parts/timer_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace parts {

namespace {

constexpr bool kLineA[4] = {false, true, true, false}, kLineB[4] = {false, false, true, true};

}  // namespace

TimerPart::TimerPart(Bus& bus, unsigned width, std::function<double()> clock_Hz)
    : bus_(bus), most_(width == 32 ? 0xFFFFFFFFu : 0xFFFFu), clock_Hz_(std::move(clock_Hz)) {
  reset();
}

void TimerPart::reset() {
  control_ = control2_ = slave_ = interrupts_ = status_ = enabled_ = 0;
  mode_[0] = mode_[1] = counter_ = prescaler_ = prescaler_now_ = 0;
  reload_ = most_;  // 18.4.12
  for (std::uint32_t& capture : capture_) capture = 0;
}

std::uint32_t TimerPart::read(std::uint32_t offset) {
  switch (offset) {
    case 0x00:
      return control_;
    case 0x04:
      return control2_;
    case 0x08:
      return slave_;
    case 0x0C:
      return interrupts_;
    case 0x10:
      return status_;
    case 0x18:
    case 0x1C:
      return mode_[(offset - 0x18) / 4];
    case 0x20:
      return enabled_;
    case 0x24:
      return counter_;
    case 0x28:
      return prescaler_;
    case 0x2C:
      return reload_;
    case 0x34:
    case 0x38:
    case 0x3C:
    case 0x40:
      status_ &= ~(2u << (offset - 0x34) / 4);  // 18.4.5: reading the captured value clears its flag
      return capture_[(offset - 0x34) / 4];
    default:
      return 0;
  }
}

void TimerPart::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x00:
      if (bits(value, 0) != 0 && bits(control_, 0) == 0) counted_until_ns_ = bus_.now_ns();
      control_ = value;
      break;
    case 0x04:
      control2_ = value;
      break;
    case 0x08:
      if (bits(slave_, 0, 3) != 0 && bits(value, 0, 3) != 0 && bits(value, 4, 3) != bits(slave_, 4, 3))
        bus_.complain("timer: trigger selected while it is used: TS cannot be changed");  // 18.4.3
      slave_ = value;
      break;
    case 0x0C:
      interrupts_ = value;
      break;
    case 0x10:
      status_ &= value;  // 18.4.5: written by zeros
      break;
    case 0x14:
      if (bits(value, 0) != 0) update();
      break;
    case 0x18:
    case 0x1C:
      if (enabled_ != 0) bus_.complain("timer: channel configured while it is on: CCxS cannot be written");  // 18.4.7
      mode_[(offset - 0x18) / 4] = value;
      break;
    case 0x20:
      enabled_ = value;
      break;
    case 0x24:
      counter_ = value & most_;
      break;
    case 0x28:
      prescaler_ = value & 0xFFFF;
      break;
    case 0x2C:
      reload_ = value & most_;
      break;
    case 0x34:
    case 0x38:
    case 0x3C:
    case 0x40:
      if (is_output((offset - 0x34) / 4)) capture_[(offset - 0x34) / 4] = value & most_;  // 18.4.13: else read-only
      break;
    default:
      break;
  }
}

/// 18.3.2: the prescaler takes effect, the counter begins anew, and with MMS 2 the trigger output pulses.
void TimerPart::update() {
  counter_ = 0;
  prescaler_now_ = prescaler_;
  counted_until_ns_ = bus_.now_ns();
  status_ |= 1u;
  if (bits(control2_, 4, 3) == 2 && on_trigger) on_trigger();
}

void TimerPart::run(double now_ns) {
  if (bits(control_, 0) == 0 || bits(slave_, 0, 3) != 0) return;
  const double tick_ns = 1e9 * (prescaler_now_ + 1) / clock_Hz_();
  double ticks = std::floor((now_ns - counted_until_ns_) / tick_ns);
  counted_until_ns_ += ticks * tick_ns;
  while (ticks > 0) {
    const double to_overflow =
        counter_ > reload_ ? static_cast<double>(most_) - counter_ + 1 : static_cast<double>(reload_) - counter_ + 1;
    const double passed = std::min({ticks, to_overflow, to_next_compare()});
    ticks -= passed;
    if (passed < to_overflow) {
      counter_ += static_cast<std::uint32_t>(passed);
    } else {
      const double kept = counted_until_ns_;
      update();
      counted_until_ns_ = kept;
    }
    compare();
  }
}

bool TimerPart::is_output(unsigned channel) const { return bits(mode_[channel / 2], channel % 2 * 8, 2) == 0; }

double TimerPart::to_next_compare() const {
  double nearest = std::numeric_limits<double>::infinity();
  for (unsigned channel = 0; channel < 4; ++channel)
    if (is_output(channel) && capture_[channel] > counter_)
      nearest = std::min(nearest, static_cast<double>(capture_[channel] - counter_));
  return nearest;
}

/// 18.3.8: the counter has reached a channel's value; 18.4.4: CCxDE requests DMA.
void TimerPart::compare() {
  for (unsigned channel = 0; channel < 4; ++channel) {
    if (!is_output(channel) || capture_[channel] != counter_) continue;
    status_ |= 2u << channel;
    if (bits(interrupts_, 9 + channel) != 0 && on_request) on_request(channel);
  }
}

/// Table of 18.4.7: the filter requires N equal samples at the clock or at a part of it (CKD 0).
double TimerPart::filter_ns(unsigned channel) const {
  const std::uint32_t field = bits(mode_[channel / 2], channel % 2 * 8 + 4, 4);
  constexpr double kSamples[16] = {0, 2, 4, 8, 6, 8, 6, 8, 6, 8, 5, 6, 8, 5, 6, 8};
  constexpr double kDivider[16] = {1, 1, 1, 1, 2, 2, 4, 4, 8, 8, 16, 16, 16, 32, 32, 32};
  return 1e9 * kSamples[field] * kDivider[field] / clock_Hz_();
}

bool TimerPart::is_input(unsigned channel) const { return bits(mode_[channel / 2], channel % 2 * 8, 2) == 1; }

void TimerPart::count(bool up) {
  if (up)
    counter_ = counter_ >= reload_ ? 0 : counter_ + 1;
  else
    counter_ = counter_ == 0 ? reload_ : counter_ - 1;
}

/// 18.3.12, table 97: SMS 1 counts the edges of TI2, 2 those of TI1, 3 both; CCxP inverts an input.
void TimerPart::edge(unsigned channel, bool rises, bool other_level) {
  const std::uint32_t encoder = bits(slave_, 0, 3);
  if (bits(control_, 0) == 0 || !is_input(0) || !is_input(1)) return;
  const bool inverted[2] = {bits(enabled_, 1) != 0, bits(enabled_, 5) != 0};
  const bool own = rises != inverted[channel], other = other_level != inverted[1 - channel];
  if (channel == 0 && (encoder == 2 || encoder == 3)) count(own != other);
  if (channel == 1 && (encoder == 1 || encoder == 3)) count(own == other);
}

void TimerPart::turn(int edges) {
  for (int left = std::abs(edges); left > 0; --left) {
    const int before = quadrature_, after = (quadrature_ + (edges > 0 ? 1 : 3)) % 4;
    quadrature_ = after;
    if (!is_wired()) continue;
    if (kLineA[before] != kLineA[after])
      edge(0, kLineA[after], kLineB[after]);
    else
      edge(1, kLineB[after], kLineA[after]);
  }
}

void TimerPart::index_spike(double length_ns) {
  if (length_ns >= filter_ns(2)) index();
}

void TimerPart::index() {
  if (!is_wired() || !is_input(2) || bits(enabled_, 8) == 0) return;
  capture(2);
}

/// 18.3.5: a second capture before the first was read sets a flag and replaces the first.
void TimerPart::capture(unsigned channel) {
  if (bits(status_, channel + 1) != 0) status_ |= 1u << (channel + 9);
  status_ |= 1u << (channel + 1);
  capture_[channel] = counter_;
}

/// 18.3.14, trigger mode: SMS 6 and TS 5 start the counter at an edge of TI1FP1, which CC1P chooses; 18.4.2: with MMS 1
/// the trigger output follows its running.
void TimerPart::line_edge(bool rises, double lasts_ns) {
  if (!is_wired() || !is_input(0) || lasts_ns < filter_ns(0)) return;
  if (bits(slave_, 0, 3) != 6 || bits(slave_, 4, 3) != 5 || rises == (bits(enabled_, 1) != 0)) return;
  if (bits(control_, 0) != 0) return;
  control_ |= 1u;
  counted_until_ns_ = bus_.now_ns();
  if (bits(control2_, 4, 3) == 1 && on_trigger) on_trigger();
}

/// 18.4.7: CC4S 3 captures at TRC, the trigger that TS selects; in encoder mode too (18.3.12).
void TimerPart::internal_trigger(unsigned input) {
  if (bits(mode_[1], 8, 2) != 3 || bits(slave_, 4, 3) != input || bits(enabled_, 12) == 0) return;
  capture(3);
}

}  // namespace parts
