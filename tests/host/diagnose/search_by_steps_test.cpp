// One effect in addition to another, in records of an independent plant. They are not part of the project; the tests
// are skipped if they are absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "host/scoreboard/answer.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

using testing::UnorderedElementsAre;

const std::filesystem::path kFar = std::filesystem::path(AXIS_SHARED_DIR) / "data" / "drive-cases-far";
const std::filesystem::path kThree = kFar / "triples" / "case-01", kPoorModel = kFar / "rough" / "case-01",
                            kGapBesideFriction = kFar / "triples" / "case-04",
                            kHardlyDamped = kFar / "encoder" / "case-01";

TEST(SearchBySteps, FindsThreeEffectsOneOnTopOfTheOther) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  if (!std::filesystem::exists(kThree)) GTEST_SKIP() << kThree << " is absent";
  const host::Answer answer = host::run_trial(host::whole_case(kThree, "three effects"));
  EXPECT_EQ(answer.verdict.status, host::Status::missing) << answer.verdict.explanation;
  EXPECT_THAT(answer.verdict.effects, UnorderedElementsAre("dac_dead_zone", "tach_ripple", "tach_lag"));
  EXPECT_LT(answer.after, 1.0);
}

/// From a poor first model, every start of a gap is worse than no gap. Catches a scan that then gives up.
TEST(SearchBySteps, FindsAGapBehindStartsThatAreWorseThanNone) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  if (!std::filesystem::exists(kPoorModel)) GTEST_SKIP() << kPoorModel << " is absent";
  const host::Answer answer = host::run_trial(host::whole_case(kPoorModel, "poor first model"));
  EXPECT_EQ(answer.verdict.status, host::Status::missing) << answer.verdict.explanation;
  EXPECT_THAT(answer.verdict.effects, UnorderedElementsAre("backlash"));
  EXPECT_LT(answer.after, 1.0);
}

/// The load carries all friction. Seed: the fit with a divided friction compared with the other form unfitted, which
/// then never reaches the gap's size.
TEST(SearchBySteps, FindsAGapBesideTwoEffectsOfFriction) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  if (!std::filesystem::exists(kGapBesideFriction)) GTEST_SKIP() << kGapBesideFriction << " is absent";
  const host::Answer answer = host::run_trial(host::whole_case(kGapBesideFriction, "gap and friction"));
  EXPECT_EQ(answer.verdict.status, host::Status::missing) << answer.verdict.explanation;
  EXPECT_THAT(answer.verdict.effects, UnorderedElementsAre("coulomb_asymmetry", "backlash", "dac_dead_zone"));
}

/// Windows begin without the ringing of the spring, so the fit takes its damping to the lower bound.
TEST(SearchBySteps, FindsASpringWhoseDampingIsOnItsBound) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  if (!std::filesystem::exists(kHardlyDamped)) GTEST_SKIP() << kHardlyDamped << " is absent";
  const host::Answer answer = host::run_trial(host::whole_case(kHardlyDamped, "hardly damped"));
  EXPECT_EQ(answer.verdict.status, host::Status::missing) << answer.verdict.explanation;
  EXPECT_THAT(answer.verdict.effects, UnorderedElementsAre("compliance"));
}

}  // namespace
