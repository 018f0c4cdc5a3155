// When a stopping axis counts as standing.
#include "firmware/core/supervision/stop_end.hpp"

#include <gtest/gtest.h>

namespace {

using firmware::kOneCount;
using firmware::MotionLimits;
using firmware::Standstill;
using firmware::StopEnd;

/// 1 count a sample, reached in 10 samples after a jerk of 10: a stop takes 20 samples.
constexpr MotionLimits kSlowLimits{kOneCount, kOneCount / 10, kOneCount / 100};

StopEnd begun() {
  StopEnd end;
  end.configure(kSlowLimits);
  end.begin();
  return end;
}

/// Samples until it has stopped; `counts_at(k)` and `at_rest(k)` give the inputs of sample k.
template <typename AtRest, typename CountsAt>
int samples_until_stopped(StopEnd& end, bool is_held, AtRest at_rest, CountsAt counts_at) {
  for (int k = 1; k <= 5000; ++k)
    if (end.has_stopped(at_rest(k), is_held, counts_at(k))) return k;
  return 0;
}

constexpr auto kAtRest = [](int) { return true; };
constexpr auto kStill = [](int) { return std::int64_t{7}; };
constexpr auto kSwings = [](int k) { return std::int64_t{k % 2}; };

TEST(StopEnd, NeedsAStandstillOfTheEncoderAfterTheReferencesRest) {
  StopEnd end = begun();
  // The first sample at rest notes the place.
  EXPECT_EQ(samples_until_stopped(end, true, kAtRest, kStill), Standstill::kSamples + 1);
  end.begin();
  EXPECT_EQ(samples_until_stopped(
                end, true, [](int k) { return k > 15; }, kStill),
            15 + Standstill::kSamples);
  end.begin();
  EXPECT_EQ(samples_until_stopped(end, true, kAtRest, [](int k) { return std::int64_t{k == 10 ? 8 : 7}; }),
            11 + Standstill::kSamples);
}

TEST(StopEnd, AReferenceThatMovesAgainBeginsTheWaitAnew) {
  StopEnd end = begun();
  EXPECT_EQ(samples_until_stopped(
                end, true, [](int k) { return k != 12; }, kStill),
            12 + Standstill::kSamples);
  end.begin();
  const int last = 20;
  EXPECT_EQ(samples_until_stopped(
                end, true, [](int k) { return k != last; }, kSwings),
            last + StopEnd::kLongestSettling);
}

TEST(StopEnd, AHeldAxisThatOscillatesIsWaitedForNoLongerThanTheSettlingTime) {
  StopEnd end = begun();
  EXPECT_EQ(samples_until_stopped(end, true, kAtRest, kSwings), StopEnd::kLongestSettling);
}

/// Without a loop there is no oscillation to give up on: the axis coasts. Only the longest time ends the wait.
TEST(StopEnd, AnAxisThatNothingHoldsIsWaitedForUntilTheLongestTime) {
  StopEnd end = begun();
  const int longest = firmware::longest_ramp(kSlowLimits) + StopEnd::kLongestSettling;
  EXPECT_EQ(samples_until_stopped(end, false, kAtRest, kSwings), longest + 1);
  end.begin();
  EXPECT_EQ(samples_until_stopped(
                end, true, [](int) { return false; }, kStill),
            longest + 1)
      << "a reference that does not come to rest";
}

TEST(StopEnd, AnotherOriginIsNoMotion) {
  StopEnd end = begun();
  for (int k = 0; k < 5; ++k) EXPECT_FALSE(end.has_stopped(true, true, 7));
  end.shift(1000);
  EXPECT_EQ(samples_until_stopped(end, true, kAtRest, [](int) { return std::int64_t{1007}; }),
            Standstill::kSamples + 1 - 5);
}

}  // namespace
