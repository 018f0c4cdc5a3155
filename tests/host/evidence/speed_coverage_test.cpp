#include "host/evidence/speed_coverage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/host/evidence/hand_made_record.hpp"

namespace {

TEST(SpeedCoverage, NamesTheSpeedsBelowTheOnlyOneThatIsHeld) {
  // The record contains only 50 rad/s: 80 mm/s.
  const host::Record record = HandMade::record();
  const host::PreparedRecord prepared = host::prepare(record, HandMade::model());
  const std::optional<host::SpeedGap> gap = host::widest_speed_gap({&prepared}, HandMade::model().data);
  ASSERT_TRUE(gap.has_value());
  EXPECT_DOUBLE_EQ(gap->low_mm_s, 0.5);
  EXPECT_GT(gap->high_mm_s, 80.0 / 1.5);
  EXPECT_LE(gap->high_mm_s, 80.5);
  EXPECT_THAT(host::speeds_to_record(*gap), testing::HasSubstr("between 0.5 and"));
}

TEST(SpeedCoverage, AnAxisThatStandsHasNoGap) {
  host::Record record = HandMade::record();
  std::ranges::fill(record.x, 0.0);
  std::ranges::fill(record.u_V, 0.0);
  const host::PreparedRecord prepared = host::prepare(record, HandMade::model());
  EXPECT_FALSE(host::widest_speed_gap({&prepared}, HandMade::model().data).has_value());
}

}  // namespace
