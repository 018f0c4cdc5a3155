// Faults provoked in the emulated board, and the next run's report of them.
#include <gtest/gtest.h>

#include "tests/target/qemu.hpp"

namespace {

using target_test::Qemu;

class Fault : public testing::Test {
 protected:
  void SetUp() override {
    const std::string why = target_test::obstacle("emulated");
    if (!why.empty()) GTEST_SKIP() << why;
  }

  /// Starts the board, sends the letter that provokes a fault, returns what the board says after the reset.
  static std::string report_after(const std::string& letter) {
    Qemu board = target_test::start_program();
    const std::string first = board.read_until("ready");
    EXPECT_NE(first.find("reset: power on"), std::string::npos) << first;
    EXPECT_NE(first.find("image: whole"), std::string::npos) << first;
    board.send(letter);
    std::string report = board.read_until("ready");
    board.send("Q");
    EXPECT_EQ(board.wait(), 0);
    return report;
  }
};

void expect_lines(const std::string& report, const std::vector<std::string>& lines) {
  for (const std::string& line : lines)
    EXPECT_NE(report.find(line), std::string::npos) << line << " not in\n" << report;
}

TEST_F(Fault, BusFaultKeepsTheAddress) {
  expect_lines(report_after("B"), {"reset: fault, resets since power on 1", "fault: bus fault",
                                   "fault: outputs made safe 1", "cfsr 0x00008200", "bfar 0xa0000000", "last: axis 1"});
}

TEST_F(Fault, ANullPointerIsNotRead) {
  expect_lines(report_after("N"), {"reset: fault", "fault: memory protection fault", "cfsr 0x00000082",
                                   "mmfar 0x00000008", "outputs made safe 1"});
}

TEST_F(Fault, DivisionByZeroIsAUsageFault) {
  expect_lines(report_after("D"), {"reset: fault", "fault: usage fault", "cfsr 0x02000000", "outputs made safe 1"});
}

/// A push into the guard is a memory protection fault with an address there. If the control interrupt comes first, its
/// frame fails without an address: in the guard or, past the guard, at the end of RAM (a bus fault).
TEST_F(Fault, StackOverflowIsNamed) {
  const std::string report = report_after("S");
  expect_lines(report, {"reset: fault", " fault, stack overflow\n", "outputs made safe 1"});
  const bool by_guard = report.find("fault: memory protection fault, stack") != std::string::npos;
  const bool past_it = report.find("fault: bus fault, stack") != std::string::npos;
  EXPECT_TRUE(by_guard || past_it) << report;
}

TEST_F(Fault, OtherFaultsAreNoStackOverflow) { EXPECT_EQ(report_after("B").find("stack overflow"), std::string::npos); }

TEST_F(Fault, AnInterruptThatNobodyServesIsNamed) {
  expect_lines(report_after("I"), {"reset: fault", "fault: hard fault, unexpected exception 40"});
}

TEST_F(Fault, AnOrderlyResetIsNoFault) {
  const std::string report = report_after("R");
  expect_lines(report, {"reset: software, resets since power on 1"});
  EXPECT_EQ(report.find("fault:"), std::string::npos) << report;
}

TEST_F(Fault, TheRecordShowsWhatTheControlInterruptDidLast) {
  Qemu board = target_test::start_program();
  board.read_until("ready");
  for (int asked = 0; asked < 500; ++asked) {  // let control periods pass; their number is in each answer
    board.send("u");
    board.read_until("periods ");
    if (std::stoul(board.read_until("\n")) >= 20) break;
  }
  board.send("B");
  board.read_until("last: control periods ");
  EXPECT_GE(std::stoul(board.read_until(",")), 20u);
}

}  // namespace
