// The axis board's own code, from start-up to control, on a simulated chip with all parts wired to its pins.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <new>
#include <vector>

#include "firmware/boards/axis-f405/board.hpp"
#include "tests/hal/parts/chip.hpp"

namespace firmware::boards {

/// Instead of the image's, which is specific to the processor.
void reset_processor() { throw parts::ChipReset("software"); }

}  // namespace firmware::boards

/// Replaces TinyUSB, which has separate tests.
namespace hal::tinyusb {

namespace {
bool attached = true;
}

bool HidPort::start(std::string_view) { return true; }
void HidPort::attach(bool is_present) { attached = is_present; }
void HidPort::poll() {}
void HidPort::handle_interrupt() {}
bool HidPort::send(const HidReport&) { return false; }
bool HidPort::receive(HidReport&) { return false; }
bool HidPort::is_configured() const { return attached; }

}  // namespace hal::tinyusb

namespace {

using firmware::boards::TextWriter;
using parts::ChipReset;
using parts::Drive;
using parts::Outside;
using Board = firmware::boards::Board;

class AxisBoard : public testing::Test {
 protected:
  AxisBoard() {
    for (parts::DmaPart* dma : {&chip.dma1, &chip.dma2})
      dma->knows(reinterpret_cast<volatile std::uint16_t*>(&board), sizeof board / 2);
    chip.handlers[56] = [this] { control_period(); };
    chip.handlers[18] = [this] { board.recover_conversions(); };
    for (const unsigned pin : {4u, 5u})
      chip.port_c.on_change[pin] = [this](Drive drive) { enables_were_on = enables_were_on || drive == Drive::high; };
    chip.port_c.on_change[12] = [this](Drive) { ++beats; };
  }
  void TearDown() override { EXPECT_EQ(chip.bus.complaints(), std::vector<std::string>{}); }

  void control_period() {
    board.acknowledge_control();
    ++periods;
    for (const std::size_t axis : {0u, 1u}) {
      counts[axis] = board.axis(axis).encoder().read().counts;
      tachometer[axis] = board.axis(axis).tachometer().read();
      EXPECT_TRUE(board.axis(axis).dac().write(words ? periods % 1000 * 10 + static_cast<int>(axis) : 0));
    }
    board.control_has_run(background_is_alive);
  }

  void start(std::uint32_t rate_Hz = 1000) {
    ASSERT_TRUE(board.start());
    board.set_control_rate(rate_Hz);
    board.start_control();
    board.start_watchdogs();
  }

  /// Runs the background as main.cpp does, for this time, in rounds of this duration.
  void run_ms(double time_ms, bool outputs_off = false, double round_ms = 0.1) {
    double fed_at_ns = chip.bus.now_ns();
    for (double left = time_ms; left > 0.0; left -= round_ms) {
      board.watch(outputs_off);
      board.feed_watchdog();
      longest_between_food_ms = std::max(longest_between_food_ms, 1e-6 * (chip.bus.now_ns() - fed_at_ns));
      fed_at_ns = chip.bus.now_ns();
      board.serial().poll();
      chip.pass_ms(round_ms);
    }
  }

  parts::Chip chip;
  Board board;
  int periods = 0, beats = 0;
  std::array<std::uint32_t, 2> counts{};
  std::array<hal::TachometerReading, 2> tachometer{};
  bool words = true, background_is_alive = true, enables_were_on = false;
  double longest_between_food_ms = 0.0;
};

TEST_F(AxisBoard, StartsSafelyFromAReset) {
  ASSERT_TRUE(board.start());
  EXPECT_EQ(chip.clock.system_Hz(), 168e6);
  EXPECT_EQ(chip.converter.output_V(0), 0.0);
  EXPECT_EQ(chip.converter.output_V(1), 0.0);
  EXPECT_EQ(chip.port_c.drive(4), Drive::low);
  EXPECT_EQ(chip.port_c.drive(5), Drive::low);
  EXPECT_FALSE(enables_were_on);
}

TEST_F(AxisBoard, StartsTheSameAfterABootRomAndAfterAnEarlierProgram) {
  chip.clock.leave_as_boot_rom();
  start();
  run_ms(5.0);
  EXPECT_FALSE(enables_were_on);
  new (&board) Board;  // as start-up initialises its variables again
  chip.interrupts.reset();
  ASSERT_NO_THROW(start());
  run_ms(5.0);
  EXPECT_FALSE(enables_were_on);
  EXPECT_GE(periods, 8);
}

TEST_F(AxisBoard, EachAxisHasItsOwnEncoderTachometerAndOutput) {
  chip.adc.input_V = [](unsigned channel) { return channel == 10 ? 2.0 : channel == 11 ? 1.0 : 0.0; };
  start();
  chip.timer2.turn(100);
  chip.timer5.turn(-7);
  run_ms(3.5);
  EXPECT_EQ(counts[0], 100u);
  EXPECT_EQ(counts[1], 0xFFFFFFF9u);
  ASSERT_TRUE(tachometer[0].valid && tachometer[1].valid);
  EXPECT_GT(tachometer[0].code, 1000);
  EXPECT_LT(tachometer[1].code, -1000);
  EXPECT_EQ(chip.converter.output_V(0), periods * 10 * 20.0 / 65536.0);
  EXPECT_EQ(chip.converter.output_V(1), (periods * 10 + 1) * 20.0 / 65536.0);
}

/// Both encoders turn by an edge every 250 ns, and each control interrupt is shut out for up to 9 us. The counter
/// itself, read in the same interrupts, shows the delays.
TEST_F(AxisBoard, LatchesPositionsAtTheSamePlaceOfEveryPeriodHoweverLateTheInterruptIs) {
  constexpr double kEdge_ns = 250.0, kPeriod_ns = 1e6;
  constexpr std::uint32_t kEdges = 4000;  // in a period
  start();
  const double begin_ns = chip.bus.now_ns();
  double interrupted_ns = 0.0;
  std::vector<std::array<std::uint32_t, 3>> seen;  // x and y as latched, x's counter
  chip.handlers[56] = [&] {
    interrupted_ns = chip.bus.now_ns() - begin_ns;
    const std::uint32_t counter = chip.timer2.read(0x24);
    control_period();
    seen.push_back({counts[0], counts[1], counter});
  };
  std::uint32_t edges = 0;
  const auto turn_until = [&](double until_ns) {
    for (double now_ns = 0.0; (now_ns = chip.bus.now_ns() - begin_ns) < until_ns;) {
      for (; kEdge_ns * edges <= now_ns; ++edges) chip.timer2.turn(1), chip.timer5.turn(-1);
      chip.bus.pass_ns(std::max(1.0, kEdge_ns - std::fmod(now_ns, kEdge_ns)));
    }
  };
  turn_until(1.5 * kPeriod_ns);
  ASSERT_EQ(seen.size(), 1u);
  const double first_ns = interrupted_ns;
  EXPECT_NEAR(first_ns - kEdge_ns * seen[0][0], 13e3, 2e3) << "latched in the middle of the scan of 26 us";
  for (int period = 1; period < 40; ++period) {
    turn_until(first_ns + period * kPeriod_ns - 2e3);
    chip.bus.shut_out(true);
    turn_until(first_ns + period * kPeriod_ns + period * 2617 % 9000);
    chip.bus.shut_out(false);
  }
  turn_until(first_ns + 39.5 * kPeriod_ns);
  ASSERT_EQ(seen.size(), 40u);
  std::uint32_t shortest = kEdges, longest = kEdges;
  for (std::size_t i = 1; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i][0] - seen[i - 1][0], kEdges) << i;
    EXPECT_EQ(seen[i - 1][1] - seen[i][1], kEdges) << i;
    shortest = std::min(shortest, seen[i][2] - seen[i - 1][2]);
    longest = std::max(longest, seen[i][2] - seen[i - 1][2]);
  }
  EXPECT_GT(longest - shortest, 30u) << "nothing was shut out";
}

TEST_F(AxisBoard, EachAxisHasItsOwnLines) {
  start();
  board.axis(0).drive_enable().set(true);
  EXPECT_EQ(chip.port_c.drive(4), Drive::high);
  EXPECT_EQ(chip.port_c.drive(5), Drive::low);
  chip.port_c.put(7, Outside::low);
  EXPECT_TRUE(board.axis(0).drive_enable().is_faulted());
  EXPECT_FALSE(board.axis(1).drive_enable().is_faulted());
  chip.port_c.put(3, Outside::low);
  EXPECT_FALSE(board.axis(0).drive_enable().is_ready());
  EXPECT_TRUE(board.axis(1).drive_enable().is_ready());
  chip.port_c.put(14, Outside::low);
  EXPECT_TRUE(board.axis(0).encoder().is_faulted());
  EXPECT_FALSE(board.axis(1).encoder().is_faulted());
  board.axis(1).drive_enable().release_brake(true);
  EXPECT_EQ(chip.port_a.drive(3), Drive::low);
  EXPECT_EQ(chip.port_b.drive(1), Drive::high);
  chip.port_b.put(15, Outside::low);
  EXPECT_TRUE(board.axis(0).limits().read().positive_end);
  EXPECT_FALSE(board.axis(1).limits().read().positive_end);
  chip.port_c.put(9, Outside::low);
  EXPECT_TRUE(board.axis(1).limits().read().home);
  EXPECT_FALSE(board.axis(0).limits().read().home);
  EXPECT_TRUE(board.emergency_stop().is_pressed());
}

TEST_F(AxisBoard, TheProbeLatchesBothEncoders) {
  start();
  board.probe().arm(true);
  chip.timer2.turn(100);
  chip.timer5.turn(-7);
  chip.probe(true);
  chip.timer2.turn(5);
  chip.timer5.turn(5);
  ASSERT_TRUE(board.probe().has_latched() && board.probe().is_closed());
  const auto x = board.axis(0).encoder().read_latch(), y = board.axis(1).encoder().read_latch();
  ASSERT_TRUE(x.valid && y.valid);
  EXPECT_EQ(x.counts, 100u);
  EXPECT_EQ(y.counts, 0xFFFFFFF9u);
}

TEST_F(AxisBoard, PowerAndDynamicBrakesHaveTheirOwnPinsAndAFaultOfTheProcessorDropsThem) {
  start();
  board.power_relay().close(true);
  EXPECT_EQ(chip.port_c.drive(11), Drive::high);
  board.axis(0).drive_enable().set(true);
  EXPECT_EQ(chip.port_b.drive(5), Drive::high);
  EXPECT_EQ(chip.port_b.drive(11), Drive::low);
  board.axis(1).drive_enable().set(true);
  EXPECT_EQ(chip.port_b.drive(11), Drive::high);
  firmware::boards::make_outputs_safe();
  EXPECT_EQ(chip.port_c.drive(11), Drive::low);
  EXPECT_EQ(chip.port_b.drive(5), Drive::low);
  EXPECT_EQ(chip.port_b.drive(11), Drive::low);
}

/// The control interrupt writes words at any time; a reading takes two frames.
TEST_F(AxisBoard, ReadsTheConverterBackWithoutDisturbingControl) {
  constexpr double kRound_ms = 0.1037;  // meets the control interrupt at all of its phases
  start(20'000);
  run_ms(200.0, false, kRound_ms);
  EXPECT_GE(periods, 3990);
  EXPECT_TRUE(board.axis(0).dac().is_healthy());
}

TEST_F(AxisBoard, AConverterThatLostItsRegistersIsFoundAndStartedAnewOnlyWhileTheOutputsAreOff) {
  start();
  run_ms(10.0);
  words = false;
  chip.converter.power_up();
  run_ms(40.0);
  EXPECT_FALSE(board.axis(0).dac().is_healthy());
  EXPECT_FALSE(board.axis(1).dac().is_healthy());
  EXPECT_FALSE(chip.converter.output_V(0)) << "it has not been powered up";
  run_ms(10.0, true);
  EXPECT_TRUE(board.axis(0).dac().is_healthy());
  EXPECT_EQ(chip.converter.output_V(0), 0.0);
}

/// Both oscillators at their fastest; a report of 2 KB occupies the line for 180 ms.
TEST_F(AxisBoard, AReportKeepsTheBackgroundFromNothing) {
  chip.independent_watchdog.oscillator_Hz = 47e3;
  start();
  run_ms(5.0);
  longest_between_food_ms = 0.0;
  TextWriter out(board.serial());
  const double began_ns = chip.bus.now_ns();
  for (int line = 0; line < 40; ++line) out << "fault: cfsr 0x00008200 hfsr 0x00000000 bfar 0x\n";
  EXPECT_LT(chip.bus.now_ns() - began_ns, 5e6);
  run_ms(200.0);
  EXPECT_EQ(chip.serial.sent().size(), 40u * 47u);
  EXPECT_LT(longest_between_food_ms, 5.0) << "a tenth of the watchdog's time";
}

TEST_F(AxisBoard, SavingParametersDoesNotEndInAReset) {
  chip.independent_watchdog.oscillator_Hz = 47e3;
  start();
  run_ms(30.0);
  {
    const Board::ControlShutOut guard;
    board.begin_stall();
    EXPECT_EQ(board.parameter_flash().erase(1), hal::FlashResult::ok);
    board.end_stall();
  }
  run_ms(60.0);
  EXPECT_TRUE(chip.window_watchdog.is_running());
}

/// Noise spikes of an amplifier, at any phase, and an unplugged cable.
TEST_F(AxisBoard, OnlyAComputerThatStaysAwayIsGone) {
  start();
  chip.port_a.put(8, Outside::high);
  run_ms(90.0);
  EXPECT_FALSE(board.usb().is_configured());
  run_ms(20.0);
  EXPECT_TRUE(board.usb().is_configured());
  for (const double spark_ms : {0.1, 1.0, 20.0, 95.0, 95.0}) {
    chip.port_a.put(8, Outside::low);
    run_ms(spark_ms);
    EXPECT_TRUE(board.usb().is_configured()) << spark_ms;
    chip.port_a.put(8, Outside::high);
    run_ms(1.0);
  }
  chip.port_a.put(8, Outside::low);
  run_ms(110.0);
  EXPECT_FALSE(board.usb().is_configured());
}

TEST_F(AxisBoard, SaysThatItLacksItsBrownOutReset) {
  start();
  EXPECT_TRUE(board.lacks_brown_out_reset()) << "as delivered";
  chip.flash.option_bytes &= ~0xCu;  // 2.7 V
  EXPECT_FALSE(board.lacks_brown_out_reset());
  chip.flash.option_bytes |= 1u << 2;  // 2.4 V
  EXPECT_TRUE(board.lacks_brown_out_reset());
}

TEST_F(AxisBoard, ABackgroundThatHangsEndsInAReset) {
  start();
  run_ms(60.0);
  EXPECT_THROW(chip.pass_ms(60.0), ChipReset);
}

TEST_F(AxisBoard, AControlInterruptThatStopsEndsInAReset) {
  start();
  run_ms(60.0);
  chip.handlers.erase(56);
  EXPECT_THROW(run_ms(40.0), ChipReset);
}

TEST_F(AxisBoard, TheChargePumpBeatsOnceAPeriodWhileAllIsAlive) {
  start();
  run_ms(10.0);
  const int before = beats, periods_before = periods;
  run_ms(20.0);
  EXPECT_EQ(beats - before, periods - periods_before);
  background_is_alive = false;
  const int at_end = beats;
  run_ms(20.0);
  EXPECT_EQ(beats, at_end);
}

TEST_F(AxisBoard, ItsOutputsAreMadeSafeByPinsAlone) {
  start();
  board.axis(0).drive_enable().set(true);
  board.axis(1).drive_enable().set(true);
  board.axis(0).drive_enable().release_brake(true);
  board.axis(1).drive_enable().release_brake(true);
  run_ms(10.0);
  ASSERT_NE(chip.converter.output_V(0), 0.0);
  firmware::boards::make_outputs_safe();
  EXPECT_EQ(chip.port_c.drive(4), Drive::low);
  EXPECT_EQ(chip.port_c.drive(5), Drive::low);
  EXPECT_EQ(chip.port_a.drive(3), Drive::low);
  EXPECT_EQ(chip.port_b.drive(1), Drive::low);
  EXPECT_EQ(chip.converter.output_V(0), 0.0);
  EXPECT_EQ(chip.converter.output_V(1), 0.0);
}

TEST_F(AxisBoard, ADeadCrystalLeavesItDisabledButReporting) {
  chip.clock.crystal_works = false;
  EXPECT_FALSE(board.start());
  TextWriter out(board.serial());
  board.report(out);
  for (int round = 0; round < 5000; ++round) {
    board.serial().poll();
    chip.bus.pass_ns(50'000);
  }
  EXPECT_EQ(chip.serial.sent().find("option bytes: brown-out reset off, must be 270"), 0u) << chip.serial.sent();
}

TEST_F(AxisBoard, AnAbsentConverterLeavesItDisabled) {
  chip.converter.answers = false;
  EXPECT_FALSE(board.start());
  EXPECT_FALSE(board.axis(0).dac().is_healthy());
}

/// If an input is moved to such a pin, or its resistor is removed, the next download causes a short circuit.
TEST_F(AxisBoard, InputsThatTheRomsLoaderDrivesHaveAResistor) {
  struct LoaderOutput {
    const char* pin;
    hal::stm32f4::Gpio& port;
    unsigned number, function;
  };
  using namespace hal::stm32f4;  // NOLINT(google-build-using-namespace): ports
  // AN2606, STM32F40xxx/41xxx; functions as in the datasheet's table 9.
  const LoaderOutput outputs[] = {{"PA6", gpio_a(), 6, 5},
                                  {"PA9", gpio_a(), 9, 7},
                                  {"PB10", gpio_b(), 10, 7},
                                  {"PB13", gpio_b(), 13, 9},
                                  {"PC10", gpio_c(), 10, 7}};
  start();
  std::ifstream file(AXIS_TEST_DATA "/../../firmware/boards/axis-f405/front-end.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  ASSERT_NE(page.find("resistor in series"), std::string::npos);
  int shared = 0;
  for (const LoaderOutput& out : outputs) {
    const unsigned mode = out.port.MODER >> 2 * out.number & 3u;
    const unsigned function = out.port.AFR[out.number / 8] >> 4 * (out.number % 8) & 15u;
    const bool is_output_here = mode == 1 || (mode == 2 && function == out.function && out.number == 9);
    const std::size_t row = page.find("| " + std::string(out.pin) + " |");
    EXPECT_EQ(row != std::string::npos, !is_output_here) << out.pin;
    if (row == std::string::npos) continue;
    ++shared;
    EXPECT_NE(page.substr(row, page.find('\n', row) - row).find("ohm"), std::string::npos) << out.pin;
  }
  EXPECT_EQ(shared, 4);
}

TEST_F(AxisBoard, TellsWhyItWasReset) {
  using firmware::boards::ResetCause;
  const auto cause = [this](std::uint32_t flags) {
    chip.clock.set_reset_flags(flags);
    return firmware::boards::read_reset_cause();
  };
  EXPECT_EQ(cause(0x0E000000), ResetCause::power_on);  // 7.3.21: power, pin and brown-out come together
  EXPECT_EQ(cause(0x06000000), ResetCause::brown_out);
  EXPECT_EQ(cause(0x24000000), ResetCause::watchdog);
  EXPECT_EQ(cause(0x44000000), ResetCause::watchdog) << "the window watchdog too";
  EXPECT_EQ(cause(0x14000000), ResetCause::software);
  EXPECT_EQ(cause(0x04000000), ResetCause::reset_pin);
  EXPECT_EQ(firmware::boards::read_reset_cause(), ResetCause::unknown) << "the flags are cleared";
}

}  // namespace
