// The D/A converter behind the serial port: every bit goes over the lines.
#include "hal/ad5752.hpp"
#include "hal/stm32f4/spi_port.hpp"
#include "tests/hal/stm32f4/on_chip.hpp"

namespace {

using hal::ConverterState;
using hal::stm32f4::gpio_a;
using hal::stm32f4::Pin;
using hal::stm32f4::spi1;
using hal::stm32f4::SpiPort;

class Converter : public driver_test::OnRunningChip {
 protected:
  void SetUp() override {
    OnRunningChip::SetUp();
    chip.spi.is_wired = [] { return true; };
    chip.converter.clear_line(true);
    port.start();
  }
  /// Output voltage that corresponds to the code.
  static double volts(int code) { return code * 20.0 / 65536.0; }
  /// Reads back every register once.
  void watch_all() {
    for (int look = 0; look < 6; ++look) converter.watch();
  }
  void start() { ASSERT_TRUE(converter.start()); }

  SpiPort port{spi1(), Pin(gpio_a(), 4)};
  hal::Ad5752<SpiPort> converter{port};
};

TEST_F(Converter, StartsAtZeroVoltsOnBothChannels) {
  start();
  EXPECT_EQ(chip.converter.output_V(0), 0.0);
  EXPECT_EQ(chip.converter.output_V(1), 0.0);
  EXPECT_TRUE(converter.a().is_healthy());
}

TEST_F(Converter, PutsOutTheVoltsOfTheCode) {
  start();
  for (const int code : {1, -1, 32767, -32767, 12345, -4096}) {
    EXPECT_TRUE(converter.a().write(code));
    EXPECT_TRUE(converter.b().write(-code));
    EXPECT_EQ(chip.converter.output_V(0), volts(code));
    EXPECT_EQ(chip.converter.output_V(1), volts(-code));
  }
  EXPECT_EQ(volts(32767) > 9.99, true) << "full scale is ten volts";
}

TEST_F(Converter, StaysSoundWhileItIsReadBackBetweenWords) {
  start();
  for (int code = -30000; code < 30000; code += 1117) {
    converter.a().write(code);
    converter.b().write(code / 2);
    converter.watch();
    ASSERT_EQ(converter.state(), ConverterState::sound) << code;
    ASSERT_EQ(chip.converter.output_V(0), volts(code)) << "reading back changes nothing";
  }
}

TEST_F(Converter, ABrownOutThatLosesItsRangeIsFound) {
  start();
  chip.converter.power_up();
  watch_all();
  EXPECT_EQ(converter.state(), ConverterState::registers_differ);
  EXPECT_FALSE(converter.a().is_healthy());
  EXPECT_FALSE(converter.b().is_healthy());
  EXPECT_TRUE(converter.start()) << "it is sound after a new start";
  EXPECT_TRUE(converter.a().is_healthy());
}

TEST_F(Converter, AConverterThatIsAbsentDoesNotStart) {
  chip.converter.answers = false;
  EXPECT_FALSE(converter.start());
  EXPECT_EQ(converter.state(), ConverterState::registers_differ);
}

TEST_F(Converter, ACutWireBackIsFoundLater) {
  start();
  chip.converter.answers = false;
  watch_all();
  EXPECT_EQ(converter.state(), ConverterState::registers_differ);
}

TEST_F(Converter, HeatShutsItDownAndIsNamed) {
  start();
  chip.converter.heat();
  EXPECT_FALSE(chip.converter.output_V(0)) << "thermal shutdown was asked for";
  watch_all();
  EXPECT_EQ(converter.state(), ConverterState::too_hot);
  EXPECT_FALSE(converter.start()) << "still hot";
  chip.converter.cool();
  EXPECT_TRUE(converter.start());
}

TEST_F(Converter, AShortedOutputIsClampedAndNamed) {
  for (const unsigned channel : {0u, 1u}) {
    start();
    chip.converter.short_out(channel);
    EXPECT_TRUE(chip.converter.output_V(channel)) << "the clamp limits the current: the channel stays powered";
    watch_all();
    EXPECT_EQ(converter.state(), ConverterState::overloaded);
  }
}

TEST_F(Converter, AFrameThatIsDisturbedOnceIsNoFault) {
  start();
  chip.converter.answers = false;
  converter.watch();  // reads the register twice
  EXPECT_NE(converter.state(), ConverterState::sound) << "two disturbed frames are a fault";
  chip.converter.answers = true;
  start();
  chip.converter.deaf_for_answers(1);
  watch_all();
  EXPECT_EQ(converter.state(), ConverterState::sound);
}

TEST_F(Converter, ADeadPortIsReportedAndTheSelectLineReleased) {
  start();
  chip.spi.is_dead = true;
  EXPECT_FALSE(converter.a().write(100));
  EXPECT_TRUE(chip.port_a.level(4));
  converter.watch();
  EXPECT_EQ(converter.state(), ConverterState::silent);
  chip.bus.take_complaints();  // about the interrupted frame
}

TEST_F(Converter, AWordIsOutWithinTwoMicroseconds) {
  start();
  const double began_ns = chip.bus.now_ns();
  converter.a().write(1);
  EXPECT_LT(chip.bus.now_ns() - began_ns, 2000.0);
}

}  // namespace
