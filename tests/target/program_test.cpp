// The program on the emulated board: feeding of the watchdog, interrupts, and replies.
#include <gtest/gtest.h>

#include <thread>

#include "firmware/app/protocol/report.hpp"
#include "firmware/boards/emulated/report_cable.hpp"
#include "tests/host/temporary_folder.hpp"
#include "tests/target/cable_port.hpp"
#include "tests/target/qemu.hpp"

namespace {

using namespace std::chrono_literals;
using target_test::Qemu;

/// Observations of the board's bench, and the control periods.
struct Seen {
  unsigned long fed, beats, restarted, lamps, periods;
};

Seen look(Qemu& board) {
  const auto number = [&board](const std::string& before, const std::string& after) {
    board.read_until(before);
    return std::stoul(board.read_until(after));
  };
  board.send("u");
  Seen seen{};
  seen.periods = number("control periods ", "\n");
  seen.fed = number("bench: fed ", ",");
  seen.beats = number("beats ", ",");
  seen.restarted = number("scans restarted ", ",");
  seen.lamps = number("lamps ", "\nready");
  return seen;
}

/// Waits until this many control periods have passed.
Seen look_after(Qemu& board, unsigned long periods) {
  for (int asked = 0; asked < 2000; ++asked)
    if (const Seen seen = look(board); seen.periods >= periods) return seen;
  throw std::runtime_error("no control periods");
}

class Program : public testing::Test {
 protected:
  void SetUp() override {
    const std::string why = target_test::obstacle("emulated");
    if (!why.empty()) GTEST_SKIP() << why;
  }
};

TEST_F(Program, FeedsTheWatchdogAndTheChargePumpOnceAPeriod) {
  Qemu board = target_test::start_program();
  EXPECT_NE(board.read_until("ready").find("reset: power on"), std::string::npos);
  const Seen seen = look_after(board, 500);
  EXPECT_NEAR(static_cast<double>(seen.fed), static_cast<double>(seen.periods), 5.0);
  EXPECT_NEAR(static_cast<double>(seen.beats), static_cast<double>(seen.periods), 5.0);
  EXPECT_EQ(seen.lamps, 1u) << "it runs, without a fault";
  EXPECT_EQ(board.output().find("reset: watchdog"), std::string::npos);
}

/// The watchdog's warning is the NMI. Its handler must not hide the watchdog as the cause from the next run.
TEST_F(Program, EndsByTheWatchdogWithoutItsControlInterruptAndWithoutItsBackground) {
  Qemu board = target_test::start_program();
  board.read_until("ready");
  look_after(board, 100);
  board.send("T");  // the timer stops
  std::string report = board.read_until("ready");
  EXPECT_NE(report.find("reset: watchdog, resets since power on 1"), std::string::npos) << report;
  EXPECT_NE(report.find("last: control periods "), std::string::npos) << report;
  look_after(board, 100);
  board.send("H");  // the background hangs
  report = board.read_until("ready");
  EXPECT_NE(report.find("reset: watchdog, resets since power on 2"), std::string::npos) << report;
}

TEST_F(Program, ControlGoesOnAfterAnOverrunOfTheConverter) {
  Qemu board = target_test::start_program();
  board.read_until("ready");
  const unsigned long before = look_after(board, 50).periods;
  for (const unsigned long times : {1u, 2u}) {
    board.send("O");
    const Seen seen = look_after(board, before + 200 * times);
    EXPECT_EQ(seen.restarted, times);
    EXPECT_GE(seen.fed + 10, seen.periods);
  }
}

TEST_F(Program, AnswersWhatItsUsbInterruptHasTakenIn) {
  TemporaryFolder folder;
  target_test::CablePort port(folder.path("to_board"), folder.path("link.in"));
  const auto cable = std::make_unique<firmware::boards::ComputerEnd<target_test::CablePort>>(port);
  Qemu board = target_test::start_program(folder.path(""));
  const auto wait_for = [&](auto holds) {
    for (int poll = 0; poll < 10'000; ++poll) {
      while (cable->poll()) continue;
      if (holds()) return true;
      std::this_thread::sleep_for(1ms);
    }
    return false;
  };
  ASSERT_TRUE(wait_for([&] { return cable->heard_hello(); }));
  cable->set_configured(true);
  firmware::Message request;
  request.type = firmware::MessageType::identify;
  request.sequence = 7;
  ASSERT_TRUE(cable->send(firmware::encode(request)));
  hal::HidReport report{};
  ASSERT_TRUE(wait_for([&] { return cable->receive(report); })) << board.output();
  firmware::Message reply;
  ASSERT_EQ(firmware::decode(report, reply), firmware::Status::ok);
  EXPECT_EQ(reply.type, firmware::reply_to(firmware::MessageType::identify));
  EXPECT_EQ(reply.sequence, 7);
  firmware::IdentityPayload identity;
  ASSERT_TRUE(reply.get(identity));
  EXPECT_STREQ(identity.board.data(), "emulated");
}

}  // namespace
