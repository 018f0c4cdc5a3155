// The shipped program from its start, on a simulated chip: firmware/boards/program and the axis board's own code,
// unchanged, with the interrupts of the vector table.
#include <gtest/gtest.h>

#include <deque>
#include <new>

#include "firmware/app/protocol/report.hpp"
#include "firmware/boards/image/stack_use.hpp"
#include "firmware/boards/image/this_image.hpp"
#include "firmware/boards/program/application.hpp"
#include "tests/firmware/app/paper_values.hpp"
#include "tests/hal/parts/chip.hpp"

extern "C" {
[[noreturn]] void run_board();
void control_interrupt();
void adc_interrupt();
void usb_interrupt();
}

// The memory for captures from the linker script.
asm(".bss\n .balign 8\n .globl _capture_rows, _capture_end\n _capture_rows: .skip 40960\n _capture_end:\n .text\n");

namespace {

using firmware::Message;
using firmware::MessageType;
using firmware::Status;
using parts::ChipReset;
using parts::Drive;
using parts::Outside;

/// Thrown from the background to end the test.
struct Enough {};

/// Replacements for the processor-specific parts of the image, and for TinyUSB.
struct StandIn {
  firmware::ImageState image = firmware::ImageState::whole;
  bool faults_are_armed = false;
  bool usb_started = false, usb_attached = false;
  int usb_interrupts = 0;
  std::deque<hal::HidReport> to_board;
  std::vector<Message> replies;
  std::function<void()> each_round;
};
StandIn* stand_in = nullptr;

}  // namespace

namespace firmware::boards {

const ImageHeader& this_image() {
  static const ImageHeader header{};
  return header;
}
/// Reads all of the flash that the image has.
ImageState verify_this_image() {
  for (int step = 0; step < 8000; ++step) parts::Bus::current().pass_ns(2000);
  return stand_in->image;
}
void arm_fault_detection() { stand_in->faults_are_armed = true; }
void reset_processor() { throw ChipReset("software"); }
std::uint32_t stack_used_bytes() { return 1; }
std::uint32_t stack_size_bytes() { return 2; }

}  // namespace firmware::boards

namespace hal::tinyusb {

bool HidPort::start(std::string_view) {
  cortex_m::interrupt_controller().ISER[67 / 32] = 1u << 67 % 32;  // as TinyUSB's driver does
  return stand_in->usb_started = true;
}
void HidPort::attach(bool is_present) { stand_in->usb_attached = is_present; }
void HidPort::poll() { stand_in->each_round(); }
void HidPort::handle_interrupt() { ++stand_in->usb_interrupts; }
bool HidPort::send(const HidReport& report) {
  Message message;
  EXPECT_EQ(firmware::decode(report, message), Status::ok);
  stand_in->replies.push_back(message);
  return true;
}
bool HidPort::receive(HidReport& report) {
  if (stand_in->to_board.empty()) return false;
  report = stand_in->to_board.front();
  stand_in->to_board.pop_front();
  return true;
}
bool HidPort::is_configured() const { return stand_in->usb_attached; }

}  // namespace hal::tinyusb

namespace {

using firmware::boards::application;
using firmware::boards::board;

class ShippedProgram : public testing::Test {
 protected:
  ShippedProgram() {
    stand_in = &seen;
    firmware::boards::survival_record() = {};
    reset(0x0E000000);  // power on
    for (parts::DmaPart* dma : {&chip.dma1, &chip.dma2})
      dma->knows(reinterpret_cast<volatile std::uint16_t*>(&board), sizeof board / 2);
    chip.handlers[56] = [this] {
      if (++periods == 1) begin_control();
      control_interrupt();
    };
    chip.handlers[18] = adc_interrupt;
    chip.handlers[67] = usb_interrupt;
    for (const unsigned pin : {4u, 5u})
      chip.port_c.on_change[pin] = [this](Drive drive) { enables_were_on = enables_were_on || drive == Drive::high; };
    chip.port_c.on_change[12] = [this](Drive) { ++beats; };
    for (const unsigned closed : {2u, 3u, 6u, 7u, 8u, 10u}) chip.port_c.put(closed, Outside::low);
    for (const unsigned closed : {12u, 13u, 15u}) chip.port_b.put(closed, Outside::low);
    chip.port_a.put(8, Outside::high);  // a computer's supply
  }
  void TearDown() override { EXPECT_EQ(chip.bus.complaints(), std::vector<std::string>{}); }

  /// Work that must be done before the first control period.
  void begin_control() {
    EXPECT_TRUE(seen.faults_are_armed);
    EXPECT_EQ(application.active().get<"control.rate">(), stored_rate_Hz) << "parameters come out of the store first";
  }

  /// Runs from reset until this time after the background's first round.
  void run_ms(
      double time_ms, const std::function<void()>& each_round = [] {}) {
    constexpr double kRound_ms = 0.1;
    double until_ns = 0.0;
    seen.each_round = [=, this]() mutable {
      if (until_ns == 0.0) until_ns = chip.bus.now_ns() + 1e6 * time_ms;
      each_round();
      chip.pass_ms(kRound_ms);
      if (chip.bus.now_ns() > until_ns) throw Enough{};
    };
    try {
      run_board();
    } catch (const Enough&) {
    }
  }

  /// A reset, whose cause is in the chip's flags, and start-up, which initialises the program's variables again.
  void reset(std::uint32_t flags) {
    chip.clock.set_reset_flags(flags);
    chip.independent_watchdog.reset();
    chip.window_watchdog.reset();
    chip.interrupts.reset();
    periods = beats = 0;
    new (&board) firmware::boards::Board;
    new (&application) firmware::boards::Application(board);
    firmware::boards::liveness = {};
    firmware::boards::control_cycles = {};
  }

  /// The background then has no rounds, so a part ends the run, late enough for the report.
  void expect_that_it_stays_safe(double until_ms) {
    struct End : parts::PlainRegisters {
      explicit End(double until_ms) : PlainRegisters(4), until_ns(1e6 * until_ms) {}
      void run(double now_ns) override {
        if (now_ns > until_ns) throw Enough{};
      }
      double until_ns;
    } end{until_ms};
    chip.bus.attach(0x60000000, 4, end);
    EXPECT_THROW(run_board(), Enough);
    EXPECT_EQ(periods, 0);
    EXPECT_FALSE(seen.usb_started);
    EXPECT_FALSE(chip.independent_watchdog.is_running());
    EXPECT_FALSE(enables_were_on);
    EXPECT_EQ(chip.port_b.drive(9), Drive::high) << "the fault's lamp";
  }

  template <typename... Payload>
  void ask(MessageType type, const Payload&... payload) {
    Message request;
    request.type = type;
    (request.put(payload), ...);
    seen.to_board.push_back(firmware::encode(request));
  }

  /// Uses the program's own protocol and flash, and starts the program again.
  void store_rate(float rate_Hz) {
    firmware::ParameterValues values(hal::kAxisCount);
    const std::size_t place = firmware_test::place_named("control.rate");
    values.set(place, rate_Hz);
    firmware::ValuesPayload staged;
    staged.key[0] = firmware::key_at(place).code;
    staged.bits[0] = std::bit_cast<std::uint32_t>(rate_Hz);
    staged.count = 1;
    ask(MessageType::begin_staging, firmware::BeginRequest{});
    ask(MessageType::stage, staged);
    ask(MessageType::commit, firmware::CommitRequest{firmware::set_crc(values)});
    ask(MessageType::save);
    run_ms(200.0);
    ASSERT_EQ(seen.replies.size(), 4u);
    for (const Message& reply : seen.replies) EXPECT_EQ(reply.status, Status::ok);
    reset(0x14000000);
    stored_rate_Hz = rate_Hz;
  }

  parts::Chip chip;
  StandIn seen;
  int periods = 0, beats = 0;
  bool enables_were_on = false;
  float stored_rate_Hz = 1000.0F;
};

/// The first start erases the sectors of the fault log, which takes longer than the time-out of any watchdog.
TEST_F(ShippedProgram, StartsSafelyAndKeepsItsWatchdogsAndItsChargePumpAlive) {
  chip.independent_watchdog.oscillator_Hz = 47e3;
  run_ms(300.0);
  EXPECT_GT(chip.bus.now_ns(), 1e9);
  EXPECT_FALSE(enables_were_on);
  EXPECT_TRUE(chip.independent_watchdog.is_running());
  EXPECT_LT(chip.independent_watchdog.timeout_ns(), 60e6);
  EXPECT_TRUE(chip.window_watchdog.is_running());
  EXPECT_GT(periods, 250);
  EXPECT_NEAR(beats, periods, 2);
  EXPECT_EQ(chip.port_b.drive(8), Drive::high) << "it runs";
  EXPECT_EQ(chip.port_b.drive(9), Drive::low) << "without a fault";
  EXPECT_TRUE(seen.usb_started && seen.usb_attached);
  EXPECT_GT(firmware::boards::control_cycles.average(), 0u);
  EXPECT_EQ(firmware::boards::survival_record().running.control_periods, static_cast<std::uint32_t>(periods));
  EXPECT_NE(chip.serial.sent().find("reset: power on"), std::string::npos) << chip.serial.sent();
}

TEST_F(ShippedProgram, TheEmergencyStopLightsItsFaultLamp) {
  chip.port_c.put(10, Outside::open);
  run_ms(50.0);
  EXPECT_EQ(chip.port_b.drive(9), Drive::high);
}

TEST_F(ShippedProgram, ItsUsbInterruptReachesTheController) {
  int events = 0;
  run_ms(20.0, [&] {
    if (events == seen.usb_interrupts && events < 5) chip.usb_event(), ++events;
  });
  EXPECT_EQ(seen.usb_interrupts, 5);
}

TEST_F(ShippedProgram, ControlGoesOnAfterAnOverrunOfTheConverter) {
  int at_overrun = 0;
  run_ms(100.0, [&] {
    chip.dma2.is_stalled = periods >= 40 && at_overrun == 0;
    if (chip.dma2.is_stalled) chip.pass_ms(1.5), at_overrun = periods;
    chip.dma2.is_stalled = false;
  });
  EXPECT_GT(at_overrun, 0);
  EXPECT_GT(periods, at_overrun + 30);
}

TEST_F(ShippedProgram, ABackgroundThatHangsStopsTheChargePumpAndThenEndsInAReset) {
  store_rate(20'000.0F);
  int beats_then = 0, beats_at_end = 0;
  const auto hang = [&] {
    if (periods < 100) return;
    beats_then = beats;
    chip.pass_ms(15.0);
    beats_at_end = beats;
    chip.pass_ms(100.0);
  };
  EXPECT_THROW(run_ms(200.0, hang), ChipReset);
  EXPECT_GT(beats_at_end, beats_then);
  EXPECT_LE(beats_at_end, beats_then + 201) << "ten milliseconds of periods";
}

TEST_F(ShippedProgram, AControlInterruptThatStopsEndsInAReset) {
  EXPECT_THROW(run_ms(200.0,
                      [&] {
                        if (periods == 60) chip.handlers.erase(56);
                      }),
               ChipReset);
}

TEST_F(ShippedProgram, TellsTheNextRunThatItsWatchdogEndedIt) {
  run_ms(30.0);
  EXPECT_EQ(firmware::boards::survival_record().watchdog_armed, 1u);
  reset(0x24000000);
  run_ms(200.0);
  const std::string& report = chip.serial.sent();
  EXPECT_NE(report.find("reset: watchdog, resets since power on 1"), std::string::npos) << report;
  EXPECT_NE(report.find("last: control periods "), std::string::npos) << report;
}

TEST_F(ShippedProgram, ControlsWithWhatItHasStoredFromItsFirstPeriodOn) {
  store_rate(2000.0F);
  run_ms(50.0);
  EXPECT_NEAR(periods, 100, 3);
}

TEST_F(ShippedProgram, StaysSafeAndReportsWithoutItsClock) {
  chip.clock.crystal_works = false;
  expect_that_it_stays_safe(250.0);
  EXPECT_NE(chip.serial.sent().find("the clock or the D/A converter does not start"), std::string::npos)
      << chip.serial.sent();
}

TEST_F(ShippedProgram, StaysSafeAndReportsWhereItsImageIsNotWhole) {
  seen.image = firmware::ImageState::wrong_crc;
  expect_that_it_stays_safe(80.0);
  EXPECT_NE(chip.serial.sent().find("image: wrong CRC"), std::string::npos) << chip.serial.sent();
}

}  // namespace
