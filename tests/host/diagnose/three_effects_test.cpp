// Three effects at once, in records of an independent plant that are not part of the project; the test skips where they
// are absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "host/scoreboard/answer.hpp"
#include "tests/host/skip_where_instrumented.hpp"

namespace {

TEST(ThreeEffects, AreFoundOneOnTopOfTheOther) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const std::filesystem::path folder =
      std::filesystem::path(AXIS_SHARED_DIR) / "data" / "drive-cases-far" / "triples" / "case-01";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  const host::Answer answer = host::run_trial(host::whole_case(folder, "three effects"));
  EXPECT_EQ(answer.verdict.status, host::Status::missing) << answer.verdict.explanation;
  EXPECT_THAT(answer.verdict.effects, testing::UnorderedElementsAre("dac_dead_zone", "tach_ripple", "tach_lag"));
  EXPECT_LT(answer.after, 1.0);
}

}  // namespace
