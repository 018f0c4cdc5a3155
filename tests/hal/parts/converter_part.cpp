#include "tests/hal/parts/converter_part.hpp"

namespace parts {

namespace {

// Timing characteristics, in ns; kSelectHigh (t6), kSelectHighReading (t17) and kAnswerDelay (t16) from memory.
constexpr double kCycle = 33, kClockHalf = 13, kSelectHigh = 100, kSelectHighReading = 200, kSetup = 7, kHold = 2,
                 kAnswerDelay = 40, kPowerUp = 10'000;
constexpr double kTolerance = 1e-3;
constexpr std::uint32_t kClampOn = 1u << 2, kShutDownOn = 1u << 3;         // table 23
constexpr std::uint32_t kTooHot = 1u << 5, kOver[2] = {1u << 7, 1u << 9};  // table 24
constexpr std::uint32_t kPowered[2] = {1u << 0, 1u << 2};                  // table 24
enum : std::uint32_t { kDac = 0, kRange = 1, kPower = 2, kControl = 3 };   // table 17
constexpr double kSpan_V[6] = {5, 10, 10.8, 10, 20, 21.6};                 // table 21
constexpr bool kBipolar[6] = {false, false, false, true, true, true};

/// Table 17: A2 to A0; -1 is both.
int channel_of(std::uint32_t address) { return address == 0 ? 0 : address == 2 ? 1 : address == 4 ? -1 : -2; }

}  // namespace

void ConverterPart::power_up() {
  code_ = range_ = {};
  control_ = kClampOn;
  power_ = alerts_ = 0;
  hot_ = false;
}

void ConverterPart::heat() {
  hot_ = true;
  if ((control_ & kShutDownOn) == 0) return bus_.complain("converter: burnt; thermal shutdown was off");
  power_ = 0;
  alerts_ |= kTooHot;
}

void ConverterPart::short_out(unsigned channel) {
  alerts_ |= kOver[channel];
  if ((control_ & kClampOn) == 0) power_ &= ~kPowered[channel];
}

std::optional<double> ConverterPart::output_V(unsigned channel) const {
  if ((power_ & kPowered[channel]) == 0) return {};
  const std::uint32_t range = range_[channel];
  if (range > 5) return {};
  const std::uint32_t code = cleared_ ? 0 : code_[channel];
  // Two's complement in bipolar ranges, straight binary in unipolar ones (tables 7 to 10).
  const double fraction = kBipolar[range] ? static_cast<std::int16_t>(code) / 65536.0 : code / 65536.0;
  return fraction * kSpan_V[range];
}

void ConverterPart::clear_line(bool level) {
  cleared_ = !level;
  if (cleared_) code_ = {};  // CLR select 0: 0 V, and the registers are cleared too
}

void ConverterPart::select_line(bool level) {
  const double now = bus_.now_ns();
  if (level == !selected_) return;
  selected_ = !level;
  if (selected_) {
    if (now - released_at_ns_ < (reading_ ? kSelectHighReading : kSelectHigh) - kTolerance)
      bus_.complain("converter: select line high for too short");
    falls_ = 0;
    leaving_ = answer_;
    if (answer_is_reading_ && silent_frames_ > 0) {
      --silent_frames_;
      leaving_ ^= 0x5555;
    }
    return;
  }
  if (falls_ > 0 && now - fell_at_ns_ < kClockHalf) bus_.complain("converter: select line released too early");
  released_at_ns_ = now;
  reading_ = false;
  if (falls_ >= 24)
    take(shift_ & 0xFFFFFF);  // daisy chain: the last 24 bits count
  else if (falls_ > 0)
    bus_.complain("converter: a frame of fewer than 24 clocks is ignored");
}

void ConverterPart::data_line(bool level, double at_ns) {
  if (!selected_) return;
  if (level != data_ && at_ns - fell_at_ns_ < kHold)
    bus_.complain("converter: data do not hold after the clock's fall");
  if (level != data_) data_at_ns_ = at_ns;
  data_ = level;
}

void ConverterPart::clock_line(bool level, double at_ns) {
  if (level == clock_) return;
  clock_ = level;
  if (!selected_) return;
  if (level) {
    if (at_ns - rose_at_ns_ < kCycle - kTolerance) bus_.complain("converter: clock too fast");
    rose_at_ns_ = at_ns;
    line_before_ = line_;
    line_ = (leaving_ & 1u << 23) != 0;
    leaving_ <<= 1;
    return;
  }
  if (at_ns - data_at_ns_ < kSetup) bus_.complain("converter: data too late for the clock's fall");
  fell_at_ns_ = at_ns;
  shift_ = shift_ << 1 | (data_ ? 1u : 0u);
  ++falls_;
}

bool ConverterPart::answer_line(double at_ns) {
  if (!answers || !selected_) return false;
  return at_ns - rose_at_ns_ < kAnswerDelay ? line_before_ : line_;
}

std::uint32_t ConverterPart::read_back(std::uint32_t word) const {
  const std::uint32_t address = bits(word, 16, 3);
  const int channel = channel_of(address);
  switch (bits(word, 19, 3)) {
    case kDac:
      return channel >= 0 ? code_[static_cast<unsigned>(channel)] : 0;
    case kRange:
      return channel >= 0 ? range_[static_cast<unsigned>(channel)] : 0;
    case kPower:
      return power_ | alerts_;
    case kControl:
      return control_;
    default:
      return 0;
  }
}

void ConverterPart::take(std::uint32_t word) {
  const std::uint32_t data = word & 0xFFFF, address = bits(word, 16, 3);
  if (bits(word, 22) != 0) return;  // table 15: must be 0
  answer_is_reading_ = false;
  answer_ = word;  // daisy chain: the received word is sent with the next frame
  if (bits(word, 23) != 0) {
    answer_ = (word & 0xFF0000) | read_back(word);
    reading_ = answer_is_reading_ = true;
    return;
  }
  const int channel = channel_of(address);
  const auto each = [&](auto act) {
    for (unsigned i = 0; i < 2; ++i)
      if (channel == -1 || channel == static_cast<int>(i)) act(i);
  };
  switch (bits(word, 19, 3)) {
    case kDac:
      each([&](unsigned i) {
        if ((power_ & kPowered[i]) != 0 && bus_.now_ns() - powered_at_ns_[i] < kPowerUp)
          bus_.complain("converter: output loaded within 10 us of its power-up");
        code_[i] = cleared_ ? 0 : data;
      });
      break;
    case kRange:
      each([&](unsigned i) { range_[i] = data & 7; });
      break;
    case kPower:
      for (unsigned i = 0; i < 2; ++i)
        if ((data & kPowered[i]) != 0 && (power_ & kPowered[i]) == 0) powered_at_ns_[i] = bus_.now_ns();
      power_ = hot_ ? 0 : data & (kPowered[0] | kPowered[1]);
      if (!hot_) alerts_ = 0;
      break;
    case kControl:
      if (address == 1) control_ = data & 0xF;  // 000: no operation; 100 clears; 101 loads
      if (address == 4) code_ = {};
      break;
    default:
      break;
  }
}

}  // namespace parts
