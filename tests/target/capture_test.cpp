// The capture in memory on the emulated processor: 100 ms of four channels at 20 kHz around a trigger.
#include <gtest/gtest.h>

#include "tests/target/qemu.hpp"

namespace {

/// Catches rows that are lost, taken twice, or counted from another sample than the trigger's.
TEST(CaptureOnTarget, HasEverySampleOfFourChannelsAtTwentyKilohertz) {
  const std::string why = target_test::obstacle("capture-m4");
  if (!why.empty()) GTEST_SKIP() << why;
  target_test::Qemu board("netduinoplus2", target_test::image("capture-m4"), testing::TempDir(),
                          {"-serial", "null", "-icount", "shift=0,align=off,sleep=off", "-semihosting-config",
                           "enable=on,target=native,chardev=out", "-chardev", "stdio,id=out"});
  EXPECT_EQ(board.wait(), 0);
  EXPECT_NE(board.output().find("capture rows 2000 trigger_row 500 out_of_step 0"), std::string::npos)
      << board.output();
}

}  // namespace
