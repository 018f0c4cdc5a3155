// The quadrature counter with an encoder on it.
#include "hal/stm32f4/encoder_timer.hpp"

#include "tests/hal/stm32f4/on_chip.hpp"

namespace {

using hal::stm32f4::EncoderTimer;
using hal::stm32f4::timer2;

class Encoder : public driver_test::OnRunningChip {
 protected:
  void SetUp() override {
    OnRunningChip::SetUp();
    chip.timer2.is_wired = [] { return true; };
    encoder.start();
  }
  EncoderTimer encoder{timer2(), 3};
};

TEST_F(Encoder, CountsEveryEdgeForwardsAndBackwards) {
  chip.timer2.turn(1000);
  EXPECT_EQ(encoder.read().counts, 1000u);
  chip.timer2.turn(-1003);
  EXPECT_EQ(encoder.read().counts, 0xFFFFFFFDu) << "three below zero, over all 32 bits";
  EXPECT_TRUE(encoder.read().valid);
}

TEST_F(Encoder, CountsAtTheFullSpeedOfAnEncoder) {
  for (int edge = 0; edge < 40; ++edge) {
    chip.timer2.turn(1);
    chip.bus.pass_ns(250);
  }
  EXPECT_EQ(encoder.read().counts, 40u);
}

TEST_F(Encoder, TellsTheIndexOnceAndWhetherOneWasMissed) {
  EXPECT_FALSE(encoder.read_index().seen);
  chip.timer2.turn(4096);
  chip.timer2.index();
  chip.timer2.turn(10);
  const auto first = encoder.read_index();
  EXPECT_TRUE(first.seen);
  EXPECT_EQ(first.counts, 4096u);
  EXPECT_FALSE(first.missed);
  EXPECT_FALSE(encoder.read_index().seen) << "told once";
  chip.timer2.index();
  chip.timer2.turn(4096);
  chip.timer2.index();
  EXPECT_TRUE(encoder.read_index().missed);
  chip.timer2.index();
  EXPECT_FALSE(encoder.read_index().missed) << "and that is told once too";
}

/// 8 samples at 84 MHz: what is shorter than 95 ns is noise.
TEST_F(Encoder, NoiseOnTheIndexLineIsNoIndex) {
  chip.timer2.index_spike(80.0);
  EXPECT_FALSE(encoder.read_index().seen);
  chip.timer2.index_spike(200.0);
  EXPECT_TRUE(encoder.read_index().seen);
}

}  // namespace
