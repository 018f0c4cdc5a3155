#include "host/compare/free_run.hpp"

#include <gtest/gtest.h>

#include "tests/host/evidence/hand_made_record.hpp"

namespace {

// A run that restarts on the way, or that uses the measured position, would not drift.
TEST(FreeRun, AddsUpWhatAModelIsWrongBy) {
  const host::Record record = HandMade::record(3.0);
  const sim::DriveDescription truth = HandMade::model();
  const host::PreparedRecord prepared = host::prepare(record, truth);
  const auto right = host::free_run_rms(truth, prepared);
  ASSERT_TRUE(right.has_value());
  sim::DriveDescription wrong = truth;
  wrong.effects.push_back({"constant_torque", {{"torque", 0.2}}, {}, {}});
  const auto drifting = host::free_run_rms(wrong, prepared);
  ASSERT_TRUE(drifting.has_value());
  EXPECT_GT(*drifting, 20.0 * *right);
}

TEST(FreeRun, NeedsAPosition) {
  host::Record record = HandMade::record(3.0);
  record.x.clear();
  EXPECT_FALSE(host::free_run_rms(HandMade::model(), host::prepare(record, HandMade::model())).has_value());
}

}  // namespace
