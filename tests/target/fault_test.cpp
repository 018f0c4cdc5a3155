// Faults provoked in the emulated board: what the next run reports of them.
#include <gtest/gtest.h>

#include "tests/target/qemu.hpp"

namespace {

using target_test::Qemu;

class Fault : public testing::Test {
 protected:
  void SetUp() override {
    const std::string why = target_test::obstacle("qemu-f405");
    if (!why.empty()) GTEST_SKIP() << why;
  }

  /// Starts the board, sends the letter that provokes a fault, returns what the board says after the reset.
  static std::string report_after(const std::string& letter) {
    Qemu board("netduinoplus2", target_test::image("qemu-f405"), testing::TempDir(),
               {"-serial", "stdio", "-semihosting-config", "enable=on,target=native"});
    const std::string first = board.read_until("ready");
    EXPECT_NE(first.find("reset: power on"), std::string::npos) << first;
    EXPECT_NE(first.find("image: whole"), std::string::npos) << first;
    board.send(letter);
    std::string report = board.read_until("ready");
    board.send("q");
    EXPECT_EQ(board.wait(), 0);
    return report;
  }
};

void expect_lines(const std::string& report, const std::vector<std::string>& lines) {
  for (const std::string& line : lines)
    EXPECT_NE(report.find(line), std::string::npos) << line << " not in\n" << report;
}

TEST_F(Fault, BusFaultKeepsTheAddress) {
  expect_lines(report_after("b"), {"reset: fault, resets since power on 1", "fault: bus fault",
                                   "fault: outputs made safe 1", "cfsr 0x00008200", "bfar 0xa0000000", "last: axis 1"});
}

TEST_F(Fault, ANullPointerIsNotRead) {
  expect_lines(report_after("n"), {"reset: fault", "fault: memory protection fault", "cfsr 0x00000082",
                                   "mmfar 0x00000008", "outputs made safe 1"});
}

TEST_F(Fault, DivisionByZeroIsAUsageFault) {
  expect_lines(report_after("d"), {"reset: fault", "fault: usage fault", "cfsr 0x02000000", "outputs made safe 1"});
}

/// A push into the guard is a memory protection fault with an address there. Where the control interrupt comes first,
/// its frame fails without an address, by the guard or, past it, by the end of RAM (a bus fault).
TEST_F(Fault, StackOverflowIsNamed) {
  const std::string report = report_after("s");
  expect_lines(report, {"reset: fault", " fault, stack overflow\n", "outputs made safe 1"});
  const bool by_guard = report.find("fault: memory protection fault, stack") != std::string::npos;
  const bool past_it = report.find("fault: bus fault, stack") != std::string::npos;
  EXPECT_TRUE(by_guard || past_it) << report;
}

TEST_F(Fault, OtherFaultsAreNoStackOverflow) { EXPECT_EQ(report_after("b").find("stack overflow"), std::string::npos); }

TEST_F(Fault, AnInterruptThatNobodyServesIsNamed) {
  expect_lines(report_after("i"), {"reset: fault", "fault: hard fault, unexpected exception 66"});
}

TEST_F(Fault, AnOrderlyResetIsNoFault) {
  const std::string report = report_after("r");
  expect_lines(report, {"reset: software, resets since power on 1"});
  EXPECT_EQ(report.find("fault:"), std::string::npos) << report;
}

TEST_F(Fault, TheRecordShowsWhatTheControlInterruptDidLast) {
  Qemu board("netduinoplus2", target_test::image("qemu-f405"), testing::TempDir(),
             {"-serial", "stdio", "-semihosting-config", "enable=on,target=native"});
  board.read_until("ready");
  for (int asked = 0; asked < 500; ++asked) {  // let control periods pass; their number is in each answer
    board.send("u");
    if (board.read_until("periods ").empty()) continue;
    if (std::stoul(board.read_until("\n")) >= 20) break;
  }
  board.send("b");
  board.read_until("last: control periods ");
  EXPECT_GE(std::stoul(board.read_until(",")), 20u);
}

TEST_F(Fault, AWatchdogResetIsReportedWithTheLastState) {
  const std::string why = target_test::obstacle("mps2-an386");
  if (!why.empty()) GTEST_SKIP() << why;
  // The watchdog's clock goes with the instructions: a host that is busy must not starve the board of its time.
  Qemu board("mps2-an386", target_test::image("mps2-an386"), testing::TempDir(),
             {"-icount", "shift=5", "-serial", "stdio", "-semihosting-config", "enable=on,target=native"});
  expect_lines(board.read_until("ready"), {"reset: power on", "image: whole"});
  board.read_until("fed 20");  // the watchdog leaves a board alone that feeds it
  board.send("c");             // stop the control interrupt: the supervisor alone must not keep the board alive
  const std::string after_control = board.read_until("ready");
  expect_lines(after_control, {"reset: watchdog, resets since power on 1", "last: control periods "});
  board.read_until("fed 20");
  board.send("p");  // stop the supervisor: the control interrupt alone must not either
  expect_lines(board.read_until("ready"), {"reset: watchdog, resets since power on 2"});
  board.send("q");
  EXPECT_EQ(board.wait(), 0);
}

}  // namespace
