// Entries of the fault log after a watchdog or a processor fault has ended a run.
#include "firmware/boards/image/reset_entry.hpp"

#include <gtest/gtest.h>

namespace {

using firmware::boards::entry_of;
using firmware::boards::FaultKind;
using firmware::boards::LastRun;
using firmware::boards::ResetCause;

LastRun run_that_ended_by(ResetCause cause) {
  LastRun run;
  run.cause = cause;
  run.survived = true;
  run.resets = 1;
  run.last.axis[1].enabled = 1;
  run.fault.kind = FaultKind::hard_fault;
  run.fault.pc = 0x0800A210;
  run.fault.cfsr = 0x82000000;
  run.fault.last.axis[0].enabled = 1;
  return run;
}

TEST(ResetEntry, ComesOfRunsThatDidNotEndAsTheyShould) {
  for (const ResetCause usual :
       {ResetCause::unknown, ResetCause::power_on, ResetCause::reset_pin, ResetCause::software})
    EXPECT_FALSE(entry_of(run_that_ended_by(usual))) << static_cast<int>(usual);
  for (const ResetCause bad : {ResetCause::watchdog, ResetCause::brown_out, ResetCause::fault}) {
    const auto entry = entry_of(run_that_ended_by(bad));
    ASSERT_TRUE(entry) << static_cast<int>(bad);
    EXPECT_EQ(entry->reset, static_cast<std::uint8_t>(bad));
    EXPECT_EQ(entry->fault, 0) << "no axis's";
    EXPECT_TRUE(entry->is_event());
  }
}

TEST(ResetEntry, OfAProcessorFaultSaysWhereAndWhat) {
  const auto fault = *entry_of(run_that_ended_by(ResetCause::fault));
  EXPECT_EQ(fault.counts_low, 0x0800A210u);
  EXPECT_EQ(static_cast<std::uint32_t>(fault.counts_high), 0x82000000u);
  EXPECT_EQ(fault.second_fault, 3);
  EXPECT_EQ(fault.activity, 1) << "x was enabled";
  const auto watchdog = *entry_of(run_that_ended_by(ResetCause::watchdog));
  EXPECT_EQ(watchdog.counts_low, 0u) << "of an older record";
  EXPECT_EQ(watchdog.second_fault, 0);
  EXPECT_EQ(watchdog.activity, 2) << "y was enabled";
}

/// Catches a log that is filled by a program that fails at every start.
TEST(ResetEntry, EndsAfterManyResetsInARow) {
  LastRun run = run_that_ended_by(ResetCause::fault);
  run.resets = firmware::boards::kMostLoggedResets;
  EXPECT_TRUE(entry_of(run));
  run.resets += 1;
  EXPECT_FALSE(entry_of(run));
}

}  // namespace
