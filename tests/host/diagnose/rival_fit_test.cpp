// Rivals of the best candidate are fitted from its base too. The records are not part of the project; the test skips
// where they are absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/host/diagnose/drive_case.hpp"

namespace {

/// Catches a weight whose fit ends in a valley, so that a spring eleven metres away is named in its place.
TEST(RivalFit, AWeightIsNotTakenForASpringFarAway) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const std::filesystem::path weight =
      std::filesystem::path(AXIS_SHARED_DIR) / "data" / "drive-cases" / "single" / "case-12";
  if (!std::filesystem::exists(weight)) GTEST_SKIP() << weight << " is absent";
  DriveCase stepped(weight.string());
  // Without the jog nothing moves far, and blocks of both records judge.
  std::erase_if(stepped.train, [](const host::Record& record) { return record.path.ends_with("train-jog.csv"); });
  ASSERT_EQ(stepped.train.size(), 2U);
  stepped.validate.clear();
  const host::Diagnosis diagnosis = stepped.diagnose();
  EXPECT_EQ(diagnosis.verdict.status, host::Status::ambiguous) << diagnosis.verdict.explanation;
  EXPECT_THAT(diagnosis.verdict.effects, testing::UnorderedElementsAre("constant_torque", "dac_offset"));
}

}  // namespace
