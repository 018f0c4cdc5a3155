#include "host/insight/diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/host/insight/drive_case.hpp"
#include "tests/host/insight/hand_made_record.hpp"

namespace {

using testing::Contains;
using testing::IsEmpty;

TEST(Diagnosis, AWrongInertiaIsAParameterAndNoEffect) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  DriveCase nothing_hidden("none/case-00");
  const double given = nothing_hidden.model.find("inertia")->parameters["J"] *= 1.2;
  const host::Diagnosis diagnosis = nothing_hidden.diagnose();
  EXPECT_EQ(diagnosis.verdict.status, host::Status::parameters) << diagnosis.verdict.explanation;
  EXPECT_THAT(diagnosis.verdict.parameters, Contains("inertia"));
  EXPECT_THAT(diagnosis.verdict.effects, IsEmpty());
  // truth.json: 0.00992 kg m^2.
  EXPECT_NEAR(diagnosis.base.find("inertia")->at("J"), 0.0099187, 0.02 * 0.0099187);
  EXPECT_GT(given, 1.15 * 0.0099187);
  EXPECT_LT(diagnosis.before_validate, diagnosis.given_validate);
}

TEST(Diagnosis, AnAxisThatStandsTellsNothing) {
  host::Record record = HandMade::record(5.0);
  std::ranges::fill(record.x, 12.0);
  std::ranges::fill(record.u_V, 0.1);
  for (std::size_t k = 0; k < record.size(); ++k) record.w[k] = 0.1 * std::sin(1.7 * static_cast<double>(k));
  const host::Diagnosis diagnosis = host::diagnose(HandMade::model(), {&record}, {});
  EXPECT_EQ(diagnosis.verdict.status, host::Status::insufficient_data);
  EXPECT_TRUE(diagnosis.held_back);
  EXPECT_THAT(diagnosis.verdict.effects, IsEmpty());
  EXPECT_THAT(diagnosis.candidates, IsEmpty());
  EXPECT_THAT(diagnosis.verdict.next_experiment, testing::HasSubstr("V"));
}

}  // namespace
