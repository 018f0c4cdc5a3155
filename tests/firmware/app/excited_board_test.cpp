// A board that excites an axis: with any drive and any defect, the axis stays within its box and comes to rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "tests/firmware/app/excitation_trial.hpp"

namespace {

using firmware::ExcitationEnd;
using firmware_test::ExcitationTrial;
using firmware_test::TrialFault;

int trials(int usual) {
  const char* wanted = std::getenv("AXIS_EXCITATION_TRIALS");
  return wanted != nullptr ? std::atoi(wanted) : usual;
}

/// Catches a box that is not monitored, braking with the wrong sign (motors are reversed in half of the trials), a stop
/// that waits, and an excitation that continues after a fault.
TEST(ExcitedBoard, LeavesItsBoxByNoMoreThanTheWayOfItsStop) {
  double worst_share = 0.0;
  std::map<ExcitationEnd, int> ends;
  for (int seed = 1; seed <= trials(300); ++seed) {
    ExcitationTrial trial(static_cast<std::uint64_t>(seed));
    trial.run();
    ++ends[trial.end()];
    SCOPED_TRACE(trial.describe());
    EXPECT_TRUE(trial.is_over()) << "it does not end";
    EXPECT_FALSE(trial.is_on()) << "the amplifier keeps its enable";
    if (trial.is_blind()) continue;  // the encoder is dead, and there is no tachometer: nothing shows where the axis is
    EXPECT_LT(trial.final_speed(), trial.standing_speed()) << "it does not stand";
    EXPECT_LE(trial.farthest(), trial.window() + trial.way_of_stop());
    EXPECT_LE(trial.fastest(), trial.fastest_allowed());
    worst_share = std::max(worst_share, (trial.farthest() - trial.window()) / trial.way_of_stop());
    if (HasFailure()) return;
  }
  for (const auto& [end, count] : ends) RecordProperty("ended_" + std::to_string(static_cast<int>(end)), count);
  EXPECT_GT(ends[ExcitationEnd::completed], trials(300) / 5)
      << "most trials without a defect should run their full time";
  EXPECT_GT(ends[ExcitationEnd::travel] + ends[ExcitationEnd::speed], 0) << "or nothing was tested";
  RecordProperty("worst_share_of_stop", std::to_string(worst_share));
}

}  // namespace
