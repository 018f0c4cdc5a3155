// Jogs and moves: limits, smoothness, exact ends, as properties of random admissible motions.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "firmware/core/arithmetic/count_position.hpp"
#include "firmware/core/motion/reference_generator.hpp"

namespace {

using firmware::check;
using firmware::CountPosition;
using firmware::Increment;
using firmware::kFractionBits;
using firmware::kOneCount;
using firmware::MotionLimits;
using firmware::plan_move;
using firmware::ReferenceGenerator;
using firmware::Refusal;

/// Limits from slow and stiff to fast and soft: each spans many orders of magnitude.
rc::Gen<MotionLimits> any_limits() {
  const auto power = [](int low, int high) {
    return rc::gen::map(rc::gen::pair(rc::gen::inRange(low, high), rc::gen::inRange<std::int64_t>(0, 1 << 16)),
                        [](std::pair<int, std::int64_t> p) {
                          return (Increment{1} << p.first) + ((Increment{1} << p.first) >> 16) * p.second;
                        });
  };
  return rc::gen::suchThat(rc::gen::map(rc::gen::tuple(power(36, 59), power(28, 54), power(22, 54)),
                                        [](const std::tuple<Increment, Increment, Increment>& t) {
                                          return MotionLimits{std::get<0>(t), std::get<1>(t), std::get<2>(t)};
                                        }),
                           [](const MotionLimits& limits) { return check(limits) == Refusal::none; });
}

/// Monitors increments: velocity is the increment, acceleration and jerk are its differences.
class Watch {
 public:
  explicit Watch(const MotionLimits& limits) : limits_(limits) {}
  void see(Increment velocity) {
    const Increment acceleration = velocity - velocity_;
    RC_ASSERT(std::llabs(velocity) <= limits_.velocity);
    RC_ASSERT(std::llabs(acceleration) <= limits_.acceleration);
    RC_ASSERT(std::llabs(acceleration - acceleration_) <= limits_.jerk);
    velocity_ = velocity;
    acceleration_ = acceleration;
    most_velocity = std::max<Increment>(most_velocity, std::llabs(velocity));
    most_acceleration = std::max<Increment>(most_acceleration, std::llabs(acceleration));
  }
  Increment most_velocity = 0;
  Increment most_acceleration = 0;

 private:
  MotionLimits limits_;
  Increment velocity_ = 0;
  Increment acceleration_ = 0;
};

CountPosition any_distance() {
  // Up to 2^31 counts, short ones as likely as long ones.
  const int bits = *rc::gen::inRange(0, kFractionBits + 31);
  const auto fraction = *rc::gen::inRange<std::int64_t>(0, kOneCount);
  CountPosition distance;
  if (bits < kFractionBits) {
    distance.fraction = (std::int64_t{1} << bits) - 1 + (fraction >> (kFractionBits - bits));
    distance.fraction &= kOneCount - 1;
  } else {
    distance = {std::int64_t{1} << (bits - kFractionBits), fraction};
  }
  return *rc::gen::arbitrary<bool>() ? distance : CountPosition{} - distance;
}

constexpr int kAffordable = 400000;  // samples; longer moves are exercised by the plan's arithmetic alone

RC_GTEST_PROP(Move, EndsExactlyAtItsTargetAndKeepsEveryLimit, ()) {
  const MotionLimits limits = *any_limits();
  const CountPosition distance = any_distance();
  const auto [plan, error] = plan_move(distance, limits);
  RC_PRE(error == Refusal::none && plan.samples() < kAffordable);
  ReferenceGenerator generator;
  generator.configure(limits);
  RC_ASSERT(generator.start(plan));
  Watch watch(limits);
  CountPosition position{};
  std::int64_t samples = 0;
  while (!generator.at_rest()) {
    const Increment increment = generator.next();
    RC_ASSERT(samples++ < plan.samples());
    watch.see(increment);
    position.advance(increment);
    RC_ASSERT((distance.counts < 0 ? -increment : increment) >= 0);  // never runs backwards
  }
  RC_ASSERT(position == distance);
  watch.see(generator.next());
  watch.see(generator.next());
  RC_ASSERT(generator.next() == 0);
}

RC_GTEST_PROP(Move, TakesNoLongerThanItMust, ()) {
  const auto ratio = [](int low, int high) { return rc::gen::resize(100, rc::gen::inRange<Increment>(low, high)); };
  const Increment jerk = *ratio(1 << 20, 1 << 26);
  const Increment acceleration = jerk * *ratio(30, 2000);
  const MotionLimits limits{acceleration * *ratio(30, 500), acceleration, jerk};
  CountPosition distance{};
  const Increment longest = *ratio(1, 8000);
  for (Increment k = 0; k < longest; ++k) distance.advance(limits.velocity);
  const auto [plan, error] = plan_move(distance, limits);
  RC_ASSERT(error == Refusal::none);
  const double D = static_cast<double>(limits.velocity) * static_cast<double>(longest);
  const double v = static_cast<double>(limits.velocity), a = static_cast<double>(acceleration),
               j = static_cast<double>(jerk);
  // Time-optimal duration of the continuous problem (cruise, or velocity found by bisection).
  const auto ramp = [&](double speed) { return speed * j >= a * a ? speed / a + a / j : 2.0 * std::sqrt(speed / j); };
  double low = 0.0, high = v;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * ramp(middle) <= D ? low : high) = middle;
  }
  const double optimal = D / low + ramp(low);
  // Rounding the three durations up to whole samples may cost a few of them.
  RC_ASSERT(static_cast<double>(plan.samples()) >= optimal - 1.0);
  RC_ASSERT(static_cast<double>(plan.samples()) <= optimal + 4.0);
}

/// At any moment of a jog: the jerk limit holds, the deceleration is that of a fault, and after a reset it is the usual
/// one again.
RC_GTEST_PROP(Jog, BrakesHardWithinTheLimitsOfAFault, ()) {
  MotionLimits limits = *any_limits();
  limits.fault_deceleration = limits.acceleration * *rc::gen::inRange<Increment>(1, 6);
  RC_PRE(check(limits) == Refusal::none);
  const Increment ramp = limits.velocity / limits.acceleration + limits.acceleration / limits.jerk;
  RC_PRE(ramp < kAffordable / 4);
  ReferenceGenerator generator;
  generator.configure(limits);
  MotionLimits hard = limits;
  hard.acceleration = limits.fault_deceleration;
  Watch watch(hard);
  generator.jog(limits.velocity);
  const Increment before = *rc::gen::inRange<Increment>(0, ramp + 10);
  for (Increment k = 0; k < before; ++k) watch.see(generator.next());
  RC_ASSERT(watch.most_acceleration <= limits.acceleration);  // nobody has asked for more yet
  const Increment speed = watch.most_velocity;
  generator.brake_hard();
  generator.stop();
  std::int64_t samples = 0;
  for (; !generator.at_rest(); ++samples) watch.see(generator.next());
  // The acceleration falls to zero; then at most v / a + a / j. The acceleration is a whole number of steps.
  const Increment steps = (limits.acceleration + limits.jerk - 1) / limits.jerk, step = limits.acceleration / steps;
  const Increment most = limits.fault_deceleration / step;
  const Increment fastest = speed + limits.acceleration * (steps + 1) / 2;
  RC_ASSERT(samples <= fastest / (most * step) + most + steps + 10);
  generator.reset();
  Watch after(limits);
  generator.jog(limits.velocity);
  for (Increment k = 0; k < ramp + 10; ++k) after.see(generator.next());
  generator.stop();
  while (!generator.at_rest()) after.see(generator.next());
}

RC_GTEST_PROP(Jog, KeepsEveryLimitWhateverIsAskedAndReachesWhatWasAskedLast, ()) {
  const MotionLimits limits = *any_limits();
  ReferenceGenerator generator;
  generator.configure(limits);
  Watch watch(limits);
  const Increment slack = limits.velocity;
  Increment target = 0;
  const int changes = *rc::gen::inRange(1, 12);
  for (int change = 0; change < changes; ++change) {
    target = *rc::gen::inRange<Increment>(-slack, slack + 1);
    generator.jog(target);
    const int samples = *rc::gen::inRange(1, 3000);
    for (int k = 0; k < samples; ++k) watch.see(generator.next());
  }
  // Long enough for any change: twice the full swing at half the acceleration, and the jerk's ramps.
  const std::int64_t ramps = limits.acceleration / limits.jerk + 2;
  const std::int64_t bound = 4 * (limits.velocity / limits.acceleration + 2) + 8 * ramps;
  RC_PRE(bound < kAffordable);
  Increment last = 0;
  for (std::int64_t k = 0; k < bound; ++k) watch.see(last = generator.next());
  RC_ASSERT(last == target);
  generator.stop();
  for (std::int64_t k = 0; k < bound; ++k) watch.see(last = generator.next());
  RC_ASSERT(last == 0);
  RC_ASSERT(generator.at_rest());
}

RC_GTEST_PROP(Move, CanBeStoppedOrTurnedIntoAJogAtAnySample, ()) {
  const MotionLimits limits = *any_limits();
  const CountPosition distance = any_distance();
  const auto [plan, error] = plan_move(distance, limits);
  RC_PRE(error == Refusal::none && plan.samples() < kAffordable / 4);
  ReferenceGenerator generator;
  generator.configure(limits);
  RC_ASSERT(generator.start(plan));
  Watch watch(limits);
  CountPosition position{};
  const auto see = [&](Increment increment) {
    watch.see(increment);
    position.advance(increment);
    return increment;
  };
  const auto cut = *rc::gen::inRange<std::int64_t>(0, plan.samples() + 1);
  for (std::int64_t k = 0; k < cut; ++k) see(generator.next());
  const bool stopped_while_slowing_down = cut >= plan.N1;
  const bool turned_into_a_jog = *rc::gen::arbitrary<bool>();
  const Increment target = turned_into_a_jog ? *rc::gen::inRange<Increment>(-limits.velocity, limits.velocity + 1) : 0;
  turned_into_a_jog ? generator.jog(target) : generator.stop();
  const std::int64_t bound =
      plan.samples() + 4 * (limits.velocity / limits.acceleration + 2) + 8 * (limits.acceleration / limits.jerk + 2);
  RC_PRE(bound < kAffordable);
  Increment last = 0;
  for (std::int64_t k = 0; k < bound; ++k) last = see(generator.next());
  RC_ASSERT(last == target);
  if (!turned_into_a_jog) {
    RC_ASSERT(generator.at_rest());
    if (stopped_while_slowing_down) RC_ASSERT(position == distance);
  }
}

TEST(Move, OfThePapersAxisTakesTheTimeThatItsLimitsAllow) {
  // 100 mm at 170 mm/s, 2000 mm/s^2, 50000 mm/s^3, 1 kHz, 2.44 um: 100/170 + 170/2000 + 2000/50000 = 0.7132 s.
  const double count_mm = 10.0 / 4096.0;
  const auto units = [&](double value, int order) {
    return static_cast<Increment>(value / count_mm * std::pow(1e-3, order) * static_cast<double>(kOneCount));
  };
  const MotionLimits limits{units(170.0, 1), units(2000.0, 2), units(50000.0, 3)};
  const auto [plan, error] = plan_move(CountPosition::at(40960), limits);
  ASSERT_EQ(error, Refusal::none);
  EXPECT_GE(plan.samples(), 713);
  EXPECT_LE(plan.samples(), 716);
}

TEST(Move, IsRefusedUnlessTheReferenceIsAtRest) {
  const MotionLimits limits{kOneCount, kOneCount / 100, kOneCount / 1000};
  ReferenceGenerator generator;
  generator.configure(limits);
  const auto plan = plan_move(CountPosition::at(100), limits).plan;
  generator.jog(kOneCount / 2);
  generator.next();
  EXPECT_FALSE(generator.start(plan));
  generator.stop();
  for (int k = 0; k < 1000; ++k) generator.next();
  EXPECT_TRUE(generator.start(plan));
  EXPECT_FALSE(generator.start(plan));
}

TEST(Move, OfNoDistanceIsOverAtOnce) {
  const MotionLimits limits{kOneCount, kOneCount / 100, kOneCount / 1000};
  ReferenceGenerator generator;
  generator.configure(limits);
  ASSERT_TRUE(generator.start(plan_move({}, limits).plan));
  EXPECT_TRUE(generator.at_rest());
  EXPECT_EQ(generator.next(), 0);
}

TEST(Move, ThatWouldTakeForeverIsRefused) {
  const MotionLimits slow{16, 16, 16};
  EXPECT_EQ(plan_move(CountPosition::at(1), slow).refusal, Refusal::move_too_long);
}

/// The negation of -2^63 overflows: a plan of it once divided by zero.
TEST(Move, BeyondAllCountingIsRefused) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min(),
                         kMost = std::numeric_limits<std::int64_t>::max();
  const MotionLimits fastest{kOneCount << 14, kOneCount, kOneCount >> 4};
  ASSERT_EQ(check(fastest), Refusal::none);
  for (const std::int64_t counts : {kLeast, kLeast + 1, kMost, kMost - 1, std::int64_t{1} << 62,
                                    -(std::int64_t{1} << 62), std::int64_t{1} << 43, -(std::int64_t{1} << 43) - 1})
    EXPECT_EQ(plan_move(CountPosition::at(counts), fastest).refusal, Refusal::move_too_long) << counts;
  const std::int64_t far = std::int64_t{1} << 42;
  EXPECT_EQ(plan_move(CountPosition::at(far), fastest).refusal, Refusal::none);
  EXPECT_EQ(plan_move(CountPosition::at(-far), fastest).refusal, Refusal::none);
}

TEST(MotionLimits, AreCheckedOneByOne) {
  const MotionLimits good{kOneCount, kOneCount, kOneCount};
  EXPECT_EQ(check(good), Refusal::none);
  EXPECT_EQ(check({0, good.acceleration, good.jerk}), Refusal::velocity_limit);
  EXPECT_EQ(check({(kOneCount << 14) + 1, good.acceleration, good.jerk}), Refusal::velocity_limit);
  EXPECT_EQ(check({good.velocity, -5, good.jerk}), Refusal::acceleration_limit);
  EXPECT_EQ(check({good.velocity, good.acceleration, good.jerk, firmware::kMostMotion + 1}),
            Refusal::fault_deceleration);
  EXPECT_EQ(check({good.velocity, good.acceleration, good.jerk, good.acceleration * 10}), Refusal::none);
  EXPECT_EQ(check({good.velocity, good.acceleration, 15}), Refusal::jerk_limit);
  EXPECT_EQ(check({good.velocity, good.acceleration, firmware::kLeastMotion}), Refusal::jerk_time);
}

TEST(CountPosition, AddsWithoutLossOverManySamples) {
  // A third of a count a sample cannot be represented; three million of them still add up exactly.
  CountPosition position = CountPosition::at(-7);
  const Increment third = kOneCount / 3;
  for (int k = 0; k < 3000000; ++k) position.advance(k % 2 == 0 ? third : -third - 1);
  EXPECT_EQ(position, (CountPosition{-7, 0} - CountPosition{0, 1500000}));
}

TEST(CountPosition, ExtendsACounterThatWraps) {
  firmware::CountExtender counter;
  std::uint32_t reading = 0xFFFFFFF0u;
  EXPECT_EQ(counter.extend(reading), -16);
  std::int64_t expected = -16;
  for (int k = 0; k < 10; ++k) {
    reading += 0x70000000u;
    expected += 0x70000000;
    EXPECT_EQ(counter.extend(reading), expected);
  }
  for (int k = 0; k < 20; ++k) {
    reading -= 0x70000000u;
    expected -= 0x70000000;
    EXPECT_EQ(counter.extend(reading), expected);
  }
}

}  // namespace
