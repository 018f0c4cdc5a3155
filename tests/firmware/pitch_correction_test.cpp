// Pitch error compensation alone: its addition to a reference never jumps.
#include "firmware/core/compensation/pitch_correction.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "firmware/core/axis_check.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace {

using firmware::CountPosition;
using firmware::Increment;
using firmware::kOneCount;
using firmware::kPreviewSamples;
using firmware::PitchCorrection;
using firmware::PitchPoint;

constexpr std::int32_t counts(double value) { return static_cast<std::int32_t>(value * 65536.0); }
double in_counts(Increment value) { return std::ldexp(static_cast<double>(value), -48); }

constexpr int kCrossing = 20;
const std::array<PitchPoint, 4> kTable{{{-1000, counts(2), counts(3)},
                                        {0, counts(0), counts(1)},
                                        {1000, counts(-4), counts(-2)},
                                        {3000, counts(6), counts(8)}}};

/// The expected deviation: a straight line between two points.
double deviation(double x, bool forward) {
  const auto value = [forward](const PitchPoint& p) { return (forward ? p.forward : p.backward) / 65536.0; };
  if (x <= kTable.front().counts) return value(kTable.front());
  for (std::size_t i = 1; i < kTable.size(); ++i) {
    const PitchPoint &a = kTable[i - 1], &b = kTable[i];
    if (x <= b.counts) return value(a) + (value(b) - value(a)) * (x - a.counts) / (b.counts - a.counts);
  }
  return value(kTable.back());
}

struct Reference {
  explicit Reference(bool homed = true, std::int64_t begin = 0) : is_homed(homed) {
    correction.configure({true, kCrossing});
    correction.use(kTable);
    correction.enter(CountPosition::at(begin), homed);
    motor = static_cast<double>(begin);
    wanted = motor - in_counts(correction.offset(kPreviewSamples));
  }
  void go(double by) {
    const auto increment = static_cast<Increment>(std::llround(std::ldexp(by, 48)));
    wanted += by;
    const Increment added = correction.next(increment, is_homed);
    largest_step = std::max(largest_step, std::abs(in_counts(added)));
    motor += by + in_counts(added);
  }
  /// In steps of 2.75 counts, which meet points and miss them.
  void go_to(double place) {
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(place - wanted) / 2.75)));
    const double by = (place - wanted) / steps;
    for (int i = 0; i < steps; ++i) go(by);
  }
  double added() const { return motor - wanted; }

  PitchCorrection correction;
  bool is_homed;
  double motor = 0, wanted = 0, largest_step = 0;
};

constexpr double kSlope = 0.006;  ///< slightly above that of the steepest stretch

TEST(PitchCorrection, SubtractsTheDeviationOfTheSideFromWhichItComes) {
  Reference reference;
  for (const double place : {500.0, 999.0, 1000.0, 1001.0, 2222.0, 3000.0, 5000.0}) {
    reference.go_to(place);
    EXPECT_NEAR(reference.added(), -deviation(place, true), 1e-4) << place;
  }
  for (const double place : {2999.5, 1777.25, 1000.0, 200.0, -1.0, -1000.0, -4000.0}) {
    reference.go_to(place);
    EXPECT_NEAR(reference.added(), -deviation(place, false), 1e-4) << place;
  }
}

TEST(PitchCorrection, TakesTheMeanOfBothSidesBeforeTheFirstMotion) {
  const Reference reference(true, 500);
  EXPECT_NEAR(reference.added(), -(deviation(reference.wanted, true) + deviation(reference.wanted, false)) / 2, 1e-4);
  EXPECT_FALSE(reference.correction.is_crossing());
}

/// Catches a table that is switched on, off or to another direction within one sample.
TEST(PitchCorrection, CrossesOverWithoutAJump) {
  Reference reference(false, 500);
  reference.go_to(900);
  EXPECT_EQ(reference.added(), 0.0) << "not homed";
  reference.is_homed = true;
  reference.go(0);
  EXPECT_TRUE(reference.correction.is_crossing());
  for (int i = 1; i < kCrossing; ++i) reference.go(0);
  EXPECT_FALSE(reference.correction.is_crossing());
  EXPECT_NEAR(reference.added(), -deviation(900, true), 1e-4);
  const double before = reference.added();
  reference.go(-0.5);
  EXPECT_TRUE(reference.correction.is_crossing());
  EXPECT_NEAR(reference.added(), before, 0.02);
  for (int i = 0; i < kCrossing; ++i) reference.go(-0.5);
  EXPECT_NEAR(reference.added(), -deviation(reference.wanted, false), 1e-4);
  reference.is_homed = false;
  for (int i = 0; i < kCrossing; ++i) reference.go(0);
  EXPECT_NEAR(reference.added(), 0.0, 1e-9);
  // The fastest sample of a crossing has twice its mean speed.
  EXPECT_LT(reference.largest_step, 2 * 3.7 / kCrossing * 1.2);
}

TEST(PitchCorrection, FollowsAHomeThatIsFoundElsewhere) {
  Reference reference(true, 0);
  reference.go_to(900);
  const double before = reference.added();
  reference.correction.shift(1500);
  reference.wanted += 1500;
  reference.motor += 1500;
  reference.go(0);
  EXPECT_NEAR(reference.added(), before, 0.1) << "no jump";
  for (int i = 1; i < kCrossing; ++i) reference.go(0);
  EXPECT_NEAR(reference.added(), -deviation(2400, true), 1e-4);
}

TEST(PitchCorrection, DoesNotTakeDitherForAReversal) {
  Reference reference;
  reference.go_to(500);
  for (int i = 0; i < 1000; ++i) reference.go(i % 2 == 0 ? 1e-3 : -1e-3);
  EXPECT_NEAR(reference.added(), -deviation(500, true), 1e-4);
}

TEST(PitchCorrection, IsContinuousAtAnySpeedAndPlace) {
  Reference reference;
  reference.go(1);
  for (int i = 0; i < kCrossing; ++i) reference.go(1);
  reference.largest_step = 0;
  for (const double by : {0.01, 0.3, 2.0, 7.7, 31.0}) {
    reference.largest_step = 0;
    for (int i = 0; i < 60; ++i) reference.go(by);
    EXPECT_LT(reference.largest_step, by * kSlope + 1e-4) << by;
    EXPECT_NEAR(reference.added(), -deviation(reference.wanted, true), 1e-4) << by;
  }
  reference.go(3e4);  // over all points at once
  EXPECT_NEAR(reference.added(), -deviation(1e9, true), 1e-4);
}

/// The present offset equals the offset of the newest increment kPreviewSamples ago.
TEST(PitchCorrection, ItsPreviewReachesThePresentSampleBySample) {
  Reference reference(true, 500);
  std::vector<Increment> added(kPreviewSamples, reference.correction.offset(kPreviewSamples));
  for (int k = 0; k < 200; ++k) {
    reference.go(k < 100 ? 7.7 : -7.7);
    added.push_back(reference.correction.offset(kPreviewSamples));
    for (int ahead = 0; ahead < kPreviewSamples; ++ahead)
      ASSERT_EQ(reference.correction.offset(ahead), added[added.size() - 1 - (kPreviewSamples - ahead)])
          << k << ", " << ahead;
  }
  EXPECT_NE(added.front(), added.back());
}

/// Nothing overflows at the limits of the allowed range.
TEST(PitchCorrection, HoldsTheLargestTable) {
  std::vector<PitchPoint> table;
  constexpr std::int32_t kMost = firmware::kLargestDeviation;
  table.push_back({-(1 << 30), -kMost, kMost});
  table.push_back({1 << 30, kMost, -kMost});
  ASSERT_TRUE(firmware::is_valid(table[0]) && firmware::may_follow(table[0], table[1]));
  PitchCorrection correction;
  correction.configure({true, 4});
  correction.use(table);
  correction.enter(CountPosition::at(0), true);
  EXPECT_NEAR(in_counts(correction.offset(0)), 0.0, 1e-4);
  for (const std::int64_t place : {-(1LL << 31), -(1LL << 30), -(1LL << 29), 0LL, 1LL << 29, 1LL << 30, 1LL << 31}) {
    correction.enter(CountPosition::at(place), false);
    for (int i = 0; i < 10; ++i) correction.next(kOneCount, true);
    const double share = std::min(1.0, std::max(-1.0, static_cast<double>(place + 10) / (1 << 30)));
    EXPECT_NEAR(in_counts(correction.offset(kPreviewSamples)), -8192.0 * share, 1e-3) << place;
  }
  EXPECT_EQ(correction.largest_offset(), 8192);
}

TEST(PitchTable, RefusesWhatNoScrewIs) {
  using firmware::may_follow;
  const PitchPoint zero{};
  EXPECT_TRUE(may_follow(zero, {64, 65536, -65536}));
  EXPECT_FALSE(may_follow(zero, {64, 65537, 0})) << "steeper than a sixty-fourth";
  EXPECT_FALSE(may_follow(zero, {64, 0, -65537}));
  EXPECT_FALSE(may_follow(zero, {0, 0, 0})) << "the same position twice";
  EXPECT_FALSE(may_follow({2147483647, 0, 0}, {-2147483647 - 1, 0, 0}));
  EXPECT_TRUE(may_follow({-2147483647 - 1, 0, 0}, {2147483647, 0, 0}));
  EXPECT_FALSE(firmware::is_valid({0, firmware::kLargestDeviation + 1, 0}));
  EXPECT_FALSE(firmware::is_valid({0, 0, -firmware::kLargestDeviation - 1}));
}

TEST(PitchCorrection, NeedsACrossingTimeWhileItIsOn) {
  auto parameters = firmware_test::parameters_of<float>(firmware_test::kPaperX);
  parameters.compensation.pitch = {true, 0};
  EXPECT_EQ(firmware::check(parameters), firmware::Refusal::pitch_crossing);
  parameters.compensation.pitch = {true, 4097};
  EXPECT_EQ(firmware::check(parameters), firmware::Refusal::pitch_crossing);
  parameters.compensation.pitch = {false, 0};
  EXPECT_EQ(firmware::check(parameters), firmware::Refusal::none);
}

}  // namespace
