// Homing by switch and index while the index monitor also reads the index: both get every pulse.
#include <cmath>
#include <cstdint>

#include "tests/firmware/driven_axis.hpp"

namespace {

using firmware::AxisFault;
using firmware::HomingMode;
using firmware_test::kEncoderResolution_mm;
using firmware_test::kPaperX;

constexpr std::int64_t kTurn = 4096;

/// An axis whose first pulse of a slow approach comes between the first reading of the index and the end of that
/// period.
class LateIndex : public firmware::boards::ValueAxis {
 public:
  struct Encoder {
    hal::EncoderReading reading{0, true};
    bool is_pending = false, comes_after_look = false;
    std::uint32_t pulse = 0;
    hal::EncoderReading read() const { return reading; }
    hal::IndexReading read_index() {
      const hal::IndexReading told{is_pending ? pulse : 0, is_pending, false};
      is_pending = comes_after_look;
      comes_after_look = false;
      return told;
    }
  };
  Encoder& encoder() { return encoder_; }

 private:
  Encoder encoder_;
};

/// Position of the found home, mm. The switch acts from 30 mm on; pulses are at 31.5 mm and at each further turn.
double home_mm(int phase, bool is_late) {
  auto p = firmware_test::parameters_of<float>(kPaperX);
  p.monitors.index_spacing = kTurn;
  p.homing = {.mode = HomingMode::switch_and_index,
              .velocity = 20.0f,
              .creep_velocity = 1.0f,
              .travel = 122'880,
              .index_travel = 5734,
              .position = 0,
              .turn = kTurn};
  LateIndex io;
  firmware::SupervisedAxis<float, LateIndex> axis(io);
  EXPECT_EQ(axis.configure(p), firmware::Refusal::none);
  double x_mm = 0.0, w_rad_s = 0.0;
  std::int64_t counts = 0;
  bool was_late = false;
  const auto offset = static_cast<std::int64_t>(31.5 / kEncoderResolution_mm);
  const auto turn_of = [&](std::int64_t place) {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(place - offset) / static_cast<double>(kTurn)));
  };
  const auto run = [&](int samples) {
    for (int k = 0; k < samples; ++k) {
      axis.step();
      const double u_V = io.drive_enable().on ? io.dac().code * firmware_test::kDacResolution_V : 0.0;
      x_mm += kPaperX.Ad12 * w_rad_s + kPaperX.Bd1 * u_V;
      w_rad_s = kPaperX.Ad22 * w_rad_s + kPaperX.Bd2 * u_V;
      const auto now = static_cast<std::int64_t>(std::floor(x_mm / kEncoderResolution_mm));
      if (turn_of(now) != turn_of(counts)) {
        io.encoder().pulse = static_cast<std::uint32_t>(std::max(turn_of(now), turn_of(counts)) * kTurn + offset);
        const bool creeps = std::abs(w_rad_s) < 1.0 && w_rad_s > 0.0;
        (is_late && creeps && !was_late ? io.encoder().comes_after_look : io.encoder().is_pending) = true;
        was_late = was_late || (is_late && creeps);
      }
      counts = now;
      io.encoder().reading.counts = static_cast<std::uint32_t>(now);
      io.tachometer().reading = {static_cast<std::int32_t>(std::lround(64.0 * w_rad_s)), true};
      io.limits().state.home = x_mm >= 30.0;
    }
  };
  io.tachometer().reading = {0, true};
  run(200 + phase);
  EXPECT_TRUE(axis.enable());
  run(50);
  EXPECT_TRUE(axis.home());
  for (int k = 0; k < 600 && axis.is_homing(); ++k) run(100);
  run(300);
  EXPECT_TRUE(axis.is_homed()) << phase;
  EXPECT_EQ(axis.fault(), AxisFault::none);
  return x_mm - static_cast<double>(axis.telemetry().encoder_counts) * kEncoderResolution_mm;
}

TEST(IndexHoming, LosesNoPulseToTheMonitor) {
  for (int phase = 0; phase < 16; ++phase) {
    EXPECT_NEAR(home_mm(phase, true), 31.5, 0.01) << phase;
  }
  EXPECT_NEAR(home_mm(0, false), 31.5, 0.01);
}

}  // namespace
