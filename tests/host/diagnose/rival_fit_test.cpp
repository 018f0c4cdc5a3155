// Rivals of the best candidate are also fitted from its base. The records are not part of the project; the test is
// skipped if they are absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "host/scoreboard/trial.hpp"
#include "tests/host/diagnose/drive_case.hpp"

namespace {

const std::filesystem::path kSingles = std::filesystem::path(AXIS_SHARED_DIR) / "data" / "drive-cases" / "single";
const std::filesystem::path kWeight = kSingles / "case-12", kWarm = kSingles / "case-18";

/// The first `seconds` of the sweep.
DriveCase sweep_of(const std::filesystem::path& folder, double seconds) {
  DriveCase sweep(folder.string());
  std::erase_if(sweep.train, [](const host::Record& record) { return !record.path.ends_with("train-sweep.csv"); });
  sweep.train.front() = host::read_piece({sweep.train.front().path, 0.0, seconds}, sweep.model.data);
  sweep.validate.clear();
  return sweep;
}

/// Because the weight is missing, the base has no Coulomb friction (8 s), so a start in proportion to it would be zero.
/// If a fit of the weight ends worse than the base (4 s), the weight must still be tried.
TEST(RivalFit, AWeightStaysAmongItsRivalsInASweepOfEveryLength) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  if (!std::filesystem::exists(kWeight)) GTEST_SKIP() << kWeight << " is absent";
  for (const double seconds : {4.0, 8.0}) {
    const host::Diagnosis diagnosis = sweep_of(kWeight, seconds).diagnose();
    EXPECT_EQ(diagnosis.verdict.status, host::Status::ambiguous) << diagnosis.verdict.explanation;
    EXPECT_THAT(diagnosis.verdict.effects, testing::IsSupersetOf({"constant_torque", "dac_offset"})) << seconds;
  }
}

/// If rivals are equally good over both sets, one that is slightly worse on one of them must remain.
TEST(RivalFit, FrictionThatWarmsUpStaysBesideFrictionAlongTheTravel) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  if (!std::filesystem::exists(kWarm)) GTEST_SKIP() << kWarm << " is absent";
  const host::Diagnosis diagnosis = sweep_of(kWarm, 4.0).diagnose();
  EXPECT_THAT(diagnosis.verdict.effects, testing::Contains("thermal_friction_drift"));
}

/// Catches a fit of the weight that ends in a local minimum, so that a spring eleven metres away is named instead.
TEST(RivalFit, AWeightIsNotTakenForASpringFarAway) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  if (!std::filesystem::exists(kWeight)) GTEST_SKIP() << kWeight << " is absent";
  DriveCase stepped(kWeight.string());
  // Without the jog the travel is short, and blocks of both records are held back for validation.
  std::erase_if(stepped.train, [](const host::Record& record) { return record.path.ends_with("train-jog.csv"); });
  ASSERT_EQ(stepped.train.size(), 2U);
  stepped.validate.clear();
  const host::Diagnosis diagnosis = stepped.diagnose();
  EXPECT_EQ(diagnosis.verdict.status, host::Status::ambiguous) << diagnosis.verdict.explanation;
  EXPECT_THAT(diagnosis.verdict.effects, testing::UnorderedElementsAre("constant_torque", "dac_offset"));
}

}  // namespace
