// The probe's timer and the encoders' timers that it latches.
#include "hal/stm32f4/probe_timer.hpp"

#include "hal/stm32f4/encoder_timer.hpp"
#include "tests/hal/stm32f4/on_chip.hpp"

namespace {

using hal::stm32f4::dma1;
using hal::stm32f4::EncoderTimer;
using hal::stm32f4::gpio_b;
using hal::stm32f4::gpio_c;
using hal::stm32f4::Pin;
using hal::stm32f4::ProbeTimer;
using hal::stm32f4::Pull;
using hal::stm32f4::timer2;
using hal::stm32f4::timer4;
using hal::stm32f4::timer5;

class Probe : public driver_test::OnRunningChip {
 protected:
  void SetUp() override {
    OnRunningChip::SetUp();
    chip.timer2.is_wired = chip.timer5.is_wired = [] { return true; };
    Pin(gpio_b(), 6).make_alternate(2, Pull::up);
    probe.start();
    x.start();
    y.start();
  }
  void turn(int edges) {
    chip.timer2.turn(edges);
    chip.timer5.turn(-2 * edges);
  }

  ProbeTimer probe{timer4(), Pin(gpio_b(), 6)};
  EncoderTimer x{timer2(), 3, dma1().stream[4], {gpio_c(), 13}}, y{timer5(), 2, dma1().stream[5], {gpio_c(), 14}};
};

/// A bouncing contact closes several times; the probe touched at the first closing.
TEST_F(Probe, LatchesBothEncodersAtTheFirstEdgeAlone) {
  probe.arm(true);
  EXPECT_FALSE(probe.has_latched());
  turn(1000);
  chip.probe(true);
  EXPECT_TRUE(probe.has_latched());
  EXPECT_TRUE(probe.is_closed());
  for (const bool closed : {false, true, false, true}) {
    turn(3);
    chip.bus.pass_ns(10'000);
    chip.probe(closed);
  }
  const auto first = x.read_latch(), second = y.read_latch();
  ASSERT_TRUE(first.valid && second.valid);
  EXPECT_EQ(first.counts, 1000u);
  EXPECT_EQ(second.counts, static_cast<std::uint32_t>(-2000));
  EXPECT_FALSE(x.read_latch().valid) << "told once";
}

TEST_F(Probe, ArmedAnewItLatchesTheEdgeThatIsLookedFor) {
  probe.arm(true);
  chip.probe(true);
  x.read_latch();
  turn(50);
  probe.arm(false);
  EXPECT_FALSE(probe.has_latched());
  EXPECT_FALSE(x.read_latch().valid);
  turn(50);
  chip.probe(false);
  EXPECT_TRUE(probe.has_latched());
  EXPECT_FALSE(probe.is_closed());
  EXPECT_EQ(x.read_latch().counts, 100u);
  probe.arm(false);
  chip.probe(true);
  EXPECT_FALSE(probe.has_latched()) << "the other edge";
}

TEST_F(Probe, NothingIsLatchedBeforeItIsArmed) {
  chip.probe(true);
  EXPECT_FALSE(probe.has_latched());
  EXPECT_FALSE(x.read_latch().valid);
}

/// 8 samples at 84 MHz, as on the encoders' lines: the delays of both are the same.
TEST_F(Probe, NoiseIsNoEdge) {
  probe.arm(true);
  chip.probe(true, 80.0);
  EXPECT_FALSE(probe.has_latched());
  chip.probe(true, 200.0);
  EXPECT_TRUE(probe.has_latched());
}

/// The index and the probe capture into registers of their own.
TEST_F(Probe, TheIndexIsNotTheProbe) {
  probe.arm(true);
  turn(10);
  chip.timer2.index();
  turn(10);
  chip.probe(true);
  EXPECT_EQ(x.read_index().counts, 10u);
  EXPECT_EQ(x.read_latch().counts, 20u);
}

}  // namespace
