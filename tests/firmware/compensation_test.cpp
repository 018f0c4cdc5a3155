// The board's compensation: sine, harmonics over the travel, presliding, crossing a gap.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/core/arithmetic/fixed_point.hpp"
#include "firmware/core/compensation/drive_compensation.hpp"
#include "tests/firmware/paper_axes.hpp"

namespace {

using firmware::BacklashCrossing;
using firmware::BacklashParameters;
using firmware::CountPosition;
using firmware::FixedPoint;
using firmware::Increment;
using firmware::kOneCount;
using firmware::TravelHarmonic;

double number(float value) { return static_cast<double>(value); }
double number(FixedPoint value) { return value.raw() / 2097152.0; }  // 2^21

template <typename Scalar>
class Compensation : public testing::Test {};
using Scalars = testing::Types<float, FixedPoint>;
TYPED_TEST_SUITE(Compensation, Scalars);

TYPED_TEST(Compensation, SineIsThatOfTheLibraryWithinItsStatedError) {
  // Fixed point rounds each of ten operations to 2^-22, and the argument.
  const double tolerance = std::is_same_v<TypeParam, float> ? 4e-6 : 4e-6 + 12.0 / 4194304.0;
  for (std::uint64_t turn = 0; turn < (std::uint64_t{1} << 32); turn += 999'983) {
    const double exact = std::sin(2.0 * std::numbers::pi * static_cast<double>(turn) / 4294967296.0);
    ASSERT_NEAR(number(firmware::sine_of<TypeParam>(static_cast<firmware::Turn>(turn))), exact, tolerance) << turn;
  }
}

TYPED_TEST(Compensation, HarmonicKeepsItsPhaseFarFromHome) {
  constexpr double kPeriod_counts = 1024.0;
  const TravelHarmonic<TypeParam> harmonic{TypeParam(0.3f), TypeParam(-0.2f), kOneCount / 1024};
  for (const double counts : {0.0, 0.25, 511.75, -3.5, 1e6 + 0.5, -4e9 - 100.25, 7e12 + 300.0}) {
    const double whole = std::floor(counts);
    const CountPosition x{static_cast<std::int64_t>(whole),
                          static_cast<Increment>((counts - whole) * static_cast<double>(kOneCount))};
    const double angle = 2.0 * std::numbers::pi * std::remainder(counts, kPeriod_counts) / kPeriod_counts;
    EXPECT_NEAR(number(harmonic(x)), 0.3 * std::cos(angle) - 0.2 * std::sin(angle), 5e-6) << counts;
  }
}

class PreslidingFriction : public testing::Test {
 protected:
  static constexpr float kStiffness = 50.0f;  // V/rad
  static constexpr float kPeriod_s = 1e-3f;
  firmware::FrictionParameters<float> friction{{0.8f, 0.6f, 0.0f, 1.0f, 1.0f}, {0.5f, 0.5f, 0.0f, 1.0f, 1.0f}, 0.1f};
  firmware::PreslidingFriction<float> contact;

  void slide(float speed, float level_V, double travel_rad) {
    const auto samples = std::lround(travel_rad / (std::abs(number(speed)) * 1e-3));
    for (long k = 0; k < samples; ++k) last_V = contact.advance(speed, level_V);
  }
  float last_V = 0.0f;
};

TEST_F(PreslidingFriction, ReversesOverTheTravelWhateverTheSpeed) {
  for (const float speed : {0.1f, 1.0f}) {
    contact.configure({true, kStiffness, 0.0f}, friction, kPeriod_s);
    slide(speed, 0.7f, 1.0);
    // It stops short of F once the change per sample, sigma0 dx / F of the residual, is below half a unit in the last
    // place; the rounding of 0.7 to float is smaller.
    const double half_unit_V = std::ldexp(1.0, -25);
    EXPECT_NEAR(number(last_V), 0.7, half_unit_V / (number(speed) * 1e-3 * 50.0 / 0.7) + half_unit_V) << "long since";
    // dv/dx = sigma0 (1 - v/F) backwards from +0.7 V: F = -0.5 V, so v = -0.5 + 1.2 exp(-x sigma0 / 0.5).
    slide(-speed, -0.5f, 0.01);
    const double half_sample_rad = number(speed) * 1e-3 / 2.0;
    const double expected = -0.5 + 1.2 * std::exp(-(0.01 - half_sample_rad) * 50.0 / 0.5);
    EXPECT_NEAR(number(last_V), expected, 1.2 * std::pow(half_sample_rad * 100.0, 2.0) + 1e-5);
  }
}

TEST_F(PreslidingFriction, HoldsWhileTheReferenceRestsAndForgetsWhenReset) {
  contact.configure({true, kStiffness, 0.0f}, friction, kPeriod_s);
  slide(0.1f, 0.7f, 0.01);
  const float before = contact.advance(0.0f, 0.0f);
  EXPECT_GT(before, 0.3f);
  EXPECT_EQ(contact.advance(0.0f, 0.0f), before);
  contact.reset();
  EXPECT_EQ(contact.advance(0.0f, 0.0f), 0.0f);
}

TEST_F(PreslidingFriction, DampingAddsInProportionToTheRateOfTheDeflection) {
  contact.configure({true, kStiffness, 0.2f}, friction, kPeriod_s);
  // At the first sample dv/dt = sigma0 w, so the contact's damper pulls sigma1 w; the mean over the sample is lower by
  // half of the exponent sigma0 dx / F = 50 * 0.0001 / 0.7.
  const double rise_V = 0.7 * -std::expm1(-50.0 * 1e-4 / 0.7);
  EXPECT_NEAR(number(contact.advance(0.1f, 0.7f)), rise_V / 2.0 + rise_V / 50.0 / 1e-3 * 0.2, 1e-6);
}

constexpr BacklashParameters kGap{true, 8 * kOneCount, 2 * kOneCount, 10};

TEST(BacklashCrossing, EndsHalfTheGapOnTheSideOfTheMotionAndMovesMonotonously) {
  BacklashCrossing crossing;
  crossing.configure(kGap);
  EXPECT_FALSE(crossing.is_crossing());
  Increment sum = 0;
  for (const Increment direction : {1, -1, 1}) {
    const Increment begin = sum;
    for (int k = 0; k < 10; ++k) {
      const Increment added = crossing.next(direction * kOneCount);
      EXPECT_GE(direction * added, 0);
      sum += added;
      if (k == 4) {
        EXPECT_EQ(sum, begin + (direction * 6 * kOneCount - begin) / 2) << "half the way in half the time";
      }
    }
    EXPECT_EQ(sum, direction * 6 * kOneCount);
    for (int k = 0; k < 2; ++k) EXPECT_EQ(crossing.next(direction * kOneCount), 0);
    EXPECT_FALSE(crossing.is_crossing());
  }
}

TEST(BacklashCrossing, CarriesNoFrictionInsideTheGapAndAllOnceWoundUp) {
  BacklashCrossing crossing;
  crossing.configure(kGap);
  EXPECT_EQ(crossing.carried<float>(), 0.0f);
  for (int k = 0; k < 12; ++k) crossing.next(kOneCount);
  EXPECT_EQ(crossing.carried<float>(), 1.0f);
  float last = 1.0f;
  for (int k = 0; k < 12; ++k) {
    crossing.next(-kOneCount);
    const double middle = static_cast<double>(crossing.offset(0) + crossing.offset(1)) / 2.0 / kOneCount;
    const double expected = std::copysign(std::clamp((std::abs(middle) - 4.0) / 2.0, 0.0, 1.0), middle);
    EXPECT_NEAR(number(crossing.carried<float>()), expected, 2.0 / 65536.0);
    EXPECT_LE(crossing.carried<float>(), last);
    last = crossing.carried<float>();
  }
  EXPECT_EQ(last, -1.0f);
}

TEST(BacklashCrossing, TakesNoNoticeOfAReferenceThatDithers) {
  BacklashCrossing crossing;
  crossing.configure(kGap);
  for (int k = 0; k < 1000; ++k) EXPECT_EQ(crossing.next(k % 2 == 0 ? 100 : -100), 0);
}

TEST(BacklashCrossing, TurnsRoundOnTheWay) {
  BacklashCrossing crossing;
  crossing.configure(kGap);
  Increment sum = 0;
  for (int k = 0; k < 5; ++k) sum += crossing.next(kOneCount);
  for (int k = 0; k < 12; ++k) sum += crossing.next(-kOneCount);
  EXPECT_EQ(sum, -6 * kOneCount);
}

}  // namespace
