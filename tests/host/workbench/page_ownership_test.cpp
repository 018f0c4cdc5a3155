// One page commands, and only while it shows that it is there.
#include "host/workbench/page_ownership.hpp"

#include <gtest/gtest.h>

#include "host/exit_codes.hpp"

namespace {

using host::workbench::PageOwnership;
using std::chrono::milliseconds;

constexpr PageOwnership::Time kBegin{std::chrono::hours(1)};

TEST(PageOwnership, BelongsToOnePageUntilItIsSilentForTooLong) {
  PageOwnership ownership;
  EXPECT_FALSE(ownership.is_there(kBegin));
  EXPECT_THROW(ownership.beat("", kBegin), host::Failure) << "nobody has no key";
  const std::string first = ownership.claim(kBegin);
  EXPECT_EQ(ownership.number(kBegin), 1U);
  EXPECT_THROW(ownership.claim(kBegin + milliseconds(499)), host::Failure);
  ownership.beat(first, kBegin + milliseconds(450));
  EXPECT_TRUE(ownership.is_there(kBegin + milliseconds(900)));
  EXPECT_FALSE(ownership.is_there(kBegin + milliseconds(1000)));
  EXPECT_EQ(ownership.number(kBegin + milliseconds(1000)), 0U);
  EXPECT_THROW(ownership.beat(first, kBegin + milliseconds(1000)), host::Failure)
      << "a page that slept has to claim anew";

  const std::string second = ownership.claim(kBegin + milliseconds(1000));
  EXPECT_NE(second, first);
  EXPECT_EQ(ownership.number(kBegin + milliseconds(1000)), 2U);
  EXPECT_THROW(ownership.require(first, kBegin + milliseconds(1001)), host::Failure);
  ownership.require(second, kBegin + milliseconds(1001));
  ownership.drop();
  EXPECT_THROW(ownership.require(second, kBegin + milliseconds(1002)), host::Failure);
  EXPECT_THROW(ownership.require("", kBegin + milliseconds(1002)), host::Failure);
}

}  // namespace
