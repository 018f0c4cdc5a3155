// Overrides by keys: steps, bounds, separate values for feeds and rapids.
#include "host/device/path_override.hpp"

#include <gtest/gtest.h>

namespace {

TEST(PathOverride, FeedsAndRapidsHaveTheirOwnKeysAndNeverPassThePlan) {
  host::PathOverride share;
  for (const char key : {'+', '>', '\n', ' ', 'x', '\0'}) share.press(key);
  EXPECT_EQ(share.permille(false), 1000);
  EXPECT_EQ(share.permille(true), 1000);
  for (int k = 0; k < 3; ++k) share.press('-');
  share.press('<');
  EXPECT_EQ(share.permille(false), 700);
  EXPECT_EQ(share.permille(true), 900);
  for (int k = 0; k < 30; ++k) share.press('<');
  EXPECT_EQ(share.permille(true), 100) << "0 is a feed hold, which has its own key";
  share.press('+');
  share.press('>');
  EXPECT_EQ(share.permille(false), 800);
  EXPECT_EQ(share.permille(true), 200);
}

}  // namespace
