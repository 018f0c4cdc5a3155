// Start-up in the emulator from states that a reset would not leave, and a service port that takes its time.
#include <gtest/gtest.h>

#include "tests/target/qemu.hpp"

namespace {

using target_test::Qemu;

/// The loader's vector table leads into an endless loop. A program that does not set its own runs until its first
/// interrupt; one that leaves the loader's interrupts enabled ends in a fault.
TEST(Startup, TakesItsInterruptsBackFromABootRom) {
  const std::string why = target_test::obstacle("emulated");
  if (!why.empty()) GTEST_SKIP() << why;
  Qemu board = target_test::start_program();
  board.read_until("ready");
  board.send("J");
  const std::string report = board.read_until("ready");
  EXPECT_NE(report.find("image: whole"), std::string::npos) << report;
  EXPECT_EQ(report.find("fault:"), std::string::npos) << report;
  unsigned long periods = 0;
  for (int asked = 0; asked < 500 && periods < 5; ++asked) {
    board.send("u");
    board.read_until("control periods ");
    periods = std::stoul(board.read_until("\n"));
  }
  EXPECT_GE(periods, 5u) << "control interrupts arrive";
  board.send("Q");
  EXPECT_EQ(board.wait(), 0);
}

/// Three reports in a row occupy the line for 150 ms, and the watchdog resets after 100 ms. The letters come one at a
/// time, because the board answers a letter only after the previous answer is complete.
TEST(Startup, AReportOnASlowLineKeepsNobodyFromFeedingTheWatchdog) {
  const std::string why = target_test::obstacle("emulated");
  if (!why.empty()) GTEST_SKIP() << why;
  Qemu board = target_test::start_program();
  EXPECT_NE(board.read_until("ready").find("reset: power on"), std::string::npos);
  for (int report = 0; report < 3; ++report) {
    board.send("r");
    EXPECT_NE(board.read_until("resets since power on ").find("reset: power on"), std::string::npos);
  }
  board.send("Q");
  EXPECT_EQ(board.wait(), 0);
}

}  // namespace
