// Effects that are added by name. A shipped machine with two effects.
#include "host/diagnose/addition.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"
#include "tests/host/diagnose/drive_case.hpp"

namespace {

TEST(Addition, SeveralEffectsAreFittedTogetherAndComparedWithTheGivenModel) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const DriveCase asked("pairs/case-00");
  const host::Measurements measured = host::MeasurementGate(asked.model).admit(asked.train, asked.validate);
  const host::Addition added = host::add_kind(asked.model, "viscous_asymmetry+current_loop_lag", "", measured);
  EXPECT_THAT(added.judged.kinds, testing::ElementsAre("viscous_asymmetry", "current_loop_lag"));
  for (const std::string& kind : added.judged.kinds) EXPECT_NE(added.judged.model.find(kind), nullptr) << kind;
  EXPECT_LT(added.error.validate.combined, 1.25);  // only noise is left
  const host::Addition one = host::add_kind(asked.model, "viscous_asymmetry", "", measured);
  EXPECT_DOUBLE_EQ(added.judged.before, one.judged.before);
  EXPECT_LT(added.error.validate.combined, one.error.validate.combined);
}

TEST(Addition, AFreeCurveIsAddedAlone) {
  EXPECT_THAT(host::added_kinds("backlash+cogging"), testing::ElementsAre("backlash", "cogging"));
  EXPECT_THROW(host::added_kinds("free_curve+cogging"), host::Failure);
}

}  // namespace
