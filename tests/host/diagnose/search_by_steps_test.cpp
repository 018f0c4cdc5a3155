// One effect in addition to another, in records of an independent plant. They are not part of the project; the tests
// are skipped if they are absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "host/scoreboard/answer.hpp"
#include "tests/host/skip_unless_all_machines.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

using testing::UnorderedElementsAre;

const std::filesystem::path kFar = std::filesystem::path(AXIS_SHARED_DIR) / "data" / "drive-cases-far";

class SearchBySteps : public testing::Test {
 protected:
  void SetUp() override {
    AXIS_SKIP_WHERE_INSTRUMENTED();
    if (!std::filesystem::exists(kFar)) GTEST_SKIP() << kFar << " is absent";
  }

  static host::Answer found_in(const char* name) {
    host::Answer answer = host::run_trial(host::whole_case(kFar / name, name));
    EXPECT_EQ(answer.verdict.status, host::Status::missing) << answer.verdict.explanation;
    return answer;
  }
};

TEST_F(SearchBySteps, FindsThreeEffectsOneOnTopOfTheOther) {
  const host::Answer answer = found_in("triples/case-01");
  EXPECT_THAT(answer.verdict.effects, UnorderedElementsAre("dac_dead_zone", "tach_ripple", "tach_lag"));
  EXPECT_LT(answer.after, 1.0);
}

/// From a poor first model, every start of a gap is worse than no gap. Catches a scan that then gives up.
TEST_F(SearchBySteps, FindsAGapBehindStartsThatAreWorseThanNone) {
  const host::Answer answer = found_in("rough/case-01");
  EXPECT_THAT(answer.verdict.effects, UnorderedElementsAre("backlash"));
  EXPECT_LT(answer.after, 1.0);
}

/// The load carries all friction. Seed: the fit with a divided friction compared with the other form unfitted, which
/// then never reaches the gap's size.
TEST_F(SearchBySteps, FindsAGapBesideTwoEffectsOfFriction) {
  AXIS_SKIP_UNLESS_ALL_MACHINES();
  EXPECT_THAT(found_in("triples/case-04").verdict.effects,
              UnorderedElementsAre("coulomb_asymmetry", "backlash", "dac_dead_zone"));
}

/// Windows begin without the ringing of the spring, so the fit takes its damping to the lower bound.
TEST_F(SearchBySteps, FindsASpringWhoseDampingIsOnItsBound) {
  EXPECT_THAT(found_in("encoder/case-01").verdict.effects, UnorderedElementsAre("compliance"));
}

}  // namespace
