// Plans on independently coded machines. A run that separates explanations must decide correctly; otherwise a manual
// test must be named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"
#include "tests/host/plan/plan_trial.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

using testing::HasSubstr;

std::filesystem::path shipped(const char* name) {
  return std::filesystem::path(AXIS_TEST_DATA) / "drive-cases/single" / name;
}

/// Catches rivals that are not refitted, an exchange of truth and rival, odds that the run does not confirm, and a run
/// that leaves its box.
void expect_decided(const PlanTrial& trial) {
  const TrialOutcome outcome = carried_out(trial);
  EXPECT_TRUE(outcome.completed) << trial.name << " left its box";
  EXPECT_LE(outcome.recorded_s, 10.0);
  EXPECT_EQ(outcome.best, trial.truth);
  ASSERT_FALSE(outcome.pairs.empty());
  for (const PairOutcome& pair : outcome.pairs) {
    EXPECT_TRUE(pair.separable) << pair.a << " or " << pair.b;
    EXPECT_LE(pair.came, 3.0 * pair.expected) << pair.a << " or " << pair.b;
    EXPECT_LE(pair.expected, 3.0 * pair.came) << pair.a << " or " << pair.b;
  }
}

TEST(ExperimentPlan, TellsADeadZoneFromFrictionThatGrowsWithTheLoad) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const PlanTrial dead_zone = public_trial(shipped("case-09"));
  expect_decided(dead_zone);
  expect_decided(with_load_dependent_friction(dead_zone));
}

TEST(ExperimentPlan, TellsADelayFromALag) { expect_decided(public_trial(shipped("case-06"))); }

TEST(ExperimentPlan, LeavesToHandsWhatNoMotionSeparates) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  // Without static friction, a constant torque, friction by direction and an offset cannot be told apart.
  const TrialOutcome outcome = carried_out(with_level(public_trial(shipped("case-06")), "constant_torque", 0.15));
  EXPECT_FALSE(outcome.plan.separable);
  EXPECT_TRUE(outcome.plan.run.pieces.empty());
  for (const host::PairOutlook& pair : outcome.plan.pairs) EXPECT_FALSE(pair.separable);
  EXPECT_THAT(outcome.plan.by_hand, HasSubstr("known weight"));
}

TEST(ExperimentPlan, NeedsTwoRivals) {
  const PlanTrial trial = public_trial(shipped("case-06"));
  const std::vector<const host::Record*> records{&trial.training.front()};
  EXPECT_THROW(host::plan_run(trial.model, records, {host::Rival{{"input_delay"}, trial.model, 1.0}}, kTrialBox),
               host::Failure);
}

}  // namespace
