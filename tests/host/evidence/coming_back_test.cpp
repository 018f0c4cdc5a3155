#include "host/evidence/coming_back.hpp"

#include <gtest/gtest.h>

namespace {

host::Record along(std::vector<double> x) {
  host::Record record;
  record.x = std::move(x);
  return record;
}

TEST(ComingBack, NeedsHalfOfTheRangeInEachDirection) {
  EXPECT_TRUE(host::comes_back(along({0.0, 5.0, 10.0, 4.0})));
  EXPECT_TRUE(host::comes_back(along({10.0, 0.0, 6.0})));
  EXPECT_FALSE(host::comes_back(along({0.0, 5.0, 10.0, 6.0})));
  EXPECT_FALSE(host::comes_back(along({0.0, -1.0, -0.9, -2.0, -3.0}))) << "jitter of one way";
  EXPECT_FALSE(host::comes_back(along({1.0, 1.0})));
  EXPECT_FALSE(host::comes_back(along({})));
}

}  // namespace
