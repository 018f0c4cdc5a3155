// The quadrature counter with an encoder on it.
#include "hal/stm32f4/encoder_timer.hpp"

#include "hal/stm32f4/control_timer.hpp"
#include "tests/hal/stm32f4/on_chip.hpp"

namespace {

using hal::stm32f4::ControlTimer;
using hal::stm32f4::dma1;
using hal::stm32f4::EncoderTimer;
using hal::stm32f4::timer2;
using hal::stm32f4::timer3;

class Encoder : public driver_test::OnRunningChip {
 protected:
  void SetUp() override {
    OnRunningChip::SetUp();
    chip.timer2.is_wired = [] { return true; };
    chip.dma1.knows(reinterpret_cast<volatile std::uint16_t*>(&encoder), sizeof encoder / 2);
    encoder.start();
    control.start(84'000'000, 1000);
  }
  /// The reading in the next control period.
  hal::EncoderReading read() {
    chip.pass_ms(1.0);
    return encoder.read();
  }

  EncoderTimer encoder{timer2(), 3, dma1().stream[4], {hal::stm32f4::gpio_c(), 13}};
  ControlTimer control{timer3()};
};

TEST_F(Encoder, CountsEveryEdgeForwardsAndBackwards) {
  chip.timer2.turn(1000);
  EXPECT_EQ(read().counts, 1000u);
  chip.timer2.turn(-1003);
  EXPECT_EQ(read().counts, 0xFFFFFFFDu) << "three below zero, over all 32 bits";
  EXPECT_TRUE(read().valid);
}

TEST_F(Encoder, CountsAtTheFullSpeedOfAnEncoder) {
  for (int edge = 0; edge < 40; ++edge) {
    chip.timer2.turn(1);
    chip.bus.pass_ns(250);
  }
  EXPECT_EQ(read().counts, 40u);
}

TEST_F(Encoder, StaysTheSameUntilTheNextPeriod) {
  ASSERT_EQ(read().counts, 0u);
  chip.timer2.turn(50);
  EXPECT_EQ(encoder.read().counts, 0u);
  EXPECT_EQ(read().counts, 50u);
}

/// The stream has ended, and its memory keeps an old position.
TEST_F(Encoder, ABusErrorIsAnInvalidReading) {
  ASSERT_TRUE(read().valid);
  chip.dma1.fail(4);
  EXPECT_FALSE(read().valid);
}

/// The receivers' fault output drives the line low while all wires are whole.
TEST_F(Encoder, AnOpenWireFromTheReceiversIsAFault) {
  EXPECT_TRUE(encoder.is_faulted());
  chip.port_c.put(13, parts::Outside::low);
  EXPECT_FALSE(encoder.is_faulted());
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
  EXPECT_FALSE(encoder.read_index().missed) << "it is reported once only";
}

/// 8 samples at 84 MHz: pulses shorter than 95 ns are noise.
TEST_F(Encoder, NoiseOnTheIndexLineIsNoIndex) {
  chip.timer2.index_spike(80.0);
  EXPECT_FALSE(encoder.read_index().seen);
  chip.timer2.index_spike(200.0);
  EXPECT_TRUE(encoder.read_index().seen);
}

}  // namespace
