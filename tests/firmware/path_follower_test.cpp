// The board's path follower, with axes that only sum their increments.
#include "firmware/core/path/path_follower.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/firmware/circle_in_counts.hpp"

namespace {

using firmware::CountPosition;
using firmware::Increment;
using firmware::kOneCount;
using firmware::PathEnd;
using firmware::PathPhase;
using firmware::Refusal;

constexpr std::size_t kAxes = 2;
using Follower = firmware::PathFollower<kAxes, 64>;

struct LedAxis {
  firmware::SupervisorState held = firmware::SupervisorState::enabled;
  CountPosition at{};
  Increment increment = 0;
  bool is_led = false;

  firmware::SupervisorState state() const { return held; }
  void lead(Increment wanted) {
    increment = wanted;
    is_led = true;
    at.advance(wanted);
  }
  double counts() const { return static_cast<double>(at.counts) + std::ldexp(static_cast<double>(at.fraction), -48); }
};
struct LedGroup {
  std::array<LedAxis, kAxes> axis;
  LedAxis& operator[](std::size_t i) { return axis[i]; }
};

class Followed : public testing::Test {
 protected:
  static constexpr firmware::PathUnits kUnits{16, 24, 31};
  static constexpr double kSpeed = 50.0, kAcceleration = 0.8, kJerk = 0.02;  ///< of the axes, counts and samples
  static constexpr firmware::PathLimits kLimits{50.0F, 0.8F, 0.02F};

  void open(CountPosition start = {}) {
    for (LedAxis& axis : group_.axis) axis.at = start;
    follower_.open(3, kUnits, {start, start}, {kLimits, kLimits});
    follower_.hold(false);
    follower_.override_rate(kOneCount);
    given_ = {};
    pushed_ = 0;
  }

  static constexpr double kPiece = 10.0;  ///< samples
  bool push_next(bool last) {
    std::array<std::int64_t, kAxes> given = given_;
    auto node = circle_.node(kPiece * (pushed_ + 1), kPiece, kUnits, last, given);
    node.headroom_here = node.headroom_ahead = headroom_;
    const Refusal refusal = follower_.push(node, last, [](std::size_t, std::int64_t) { return true; });
    if (refusal == Refusal::path_full) return false;
    EXPECT_EQ(refusal, Refusal::none);
    given_ = given;
    ++pushed_;
    return true;
  }
  /// Runs host and background, then the control interrupt. `most`: total number of nodes from the host.
  void step(int most) {
    while (follower_.phase() < PathPhase::stopping && pushed_ < most && push_next(pushed_ + 1 == pieces())) continue;
    follower_.prepare();
    for (LedAxis& axis : group_.axis) axis.is_led = false;
    if (follower_.phase() == PathPhase::open) {
      EXPECT_TRUE(follower_.start());
    }
    const std::array<Increment, kAxes> before{group_[0].increment, group_[1].increment};
    if (follower_.is_moving()) follower_.before_step(group_);
    for (std::size_t i = 0; i < kAxes; ++i) {
      const double change = std::ldexp(static_cast<double>(group_[i].increment - before[i]), -48);
      hardest_ = std::max(hardest_, std::abs(change) / kAcceleration);
    }
    off_ = std::max(off_, circle_.off(group_[0].counts(), group_[1].counts()));
  }
  int pieces() const { return static_cast<int>(circle_.samples / kPiece); }
  int run(int most, int samples = 100'000) {
    int k = 0;
    for (; k < samples && (k == 0 || follower_.is_moving()); ++k) step(most);
    return k;
  }

  firmware_test::Circle circle_{8000.0, 2000.0};
  Follower follower_;
  LedGroup group_;
  std::array<std::int64_t, kAxes> given_{};
  int pushed_ = 0;
  /// Headroom of the circle: its acceleration is at most 0.28, its jerk 0.0018.
  std::uint32_t headroom_ : 4 = firmware::headroom_number(1.65);
  double off_ = 0.0, hardest_ = 0.0;
};

/// Catches a clock that loses time between pieces, wrong coefficients, accumulated rounding, and a missed end.
TEST_F(Followed, IsOnThePathAtEverySampleAndExactAtItsEnd) {
  open();
  EXPECT_EQ(run(pieces()), circle_.samples) << "no time is lost";
  EXPECT_EQ(follower_.end(), PathEnd::completed);
  EXPECT_EQ(group_[0].at, CountPosition::at(0));
  EXPECT_EQ(group_[1].at, CountPosition::at(0));
  EXPECT_LT(off_, 1e-3) << "counts off the circle";
  EXPECT_LT(hardest_, 1.0);
}

/// A reference may stand between two counts; the path's end is nevertheless exact.
TEST_F(Followed, BeginsAnywhereAndEndsOnItsGrid) {
  open({5, (Increment{1} << 47) + 12345});
  run(pieces());
  EXPECT_EQ(group_[0].at, (CountPosition{5, Increment{1} << 47}));
}

TEST_F(Followed, HoldStopsOnThePathAndGoesOn) {
  open();
  for (int k = 0; k < 900; ++k) step(pieces());
  follower_.hold(true);
  int until_rest = 0;
  for (; until_rest < 1000 && follower_.rate() > 0; ++until_rest) step(pieces());
  EXPECT_LT(until_rest, 200) << "V / A and A / J are 63 and 40 samples";
  const auto stands = group_[0].at;
  for (int k = 0; k < 500; ++k) step(pieces());
  EXPECT_EQ(group_[0].at, stands);
  EXPECT_TRUE(follower_.is_moving()) << "a hold does not end the path, even with few nodes";
  follower_.hold(false);
  run(pieces());
  EXPECT_EQ(follower_.end(), PathEnd::completed);
  EXPECT_EQ(group_[1].at, CountPosition::at(0));
  EXPECT_LT(off_, 1e-3);
  EXPECT_LT(hardest_, 1.0) << "share of the acceleration limit, path and clock together";
}

TEST_F(Followed, OverrideStretchesTimeAlone) {
  open();
  follower_.override_rate(kOneCount / 4);
  const int samples = run(pieces());
  EXPECT_NEAR(samples, 4 * circle_.samples, 200);
  EXPECT_LT(off_, 1e-3);
}

/// A host that ends in the middle: the axes slow down smoothly and stand on the path, before its last node.
TEST_F(Followed, StandsOnThePathWhenNodesFailToCome) {
  for (const int sent : {5, 40, 100, 163}) {
    open();
    off_ = hardest_ = 0.0;
    run(sent);
    EXPECT_EQ(follower_.end(), PathEnd::starved) << sent;
    EXPECT_LE(follower_.elapsed(), kPiece * sent);
    EXPECT_LT(off_, 1e-3) << sent;
    EXPECT_LT(hardest_, 1.0) << sent;
    EXPECT_EQ(follower_.rate(), 0);
  }
}

TEST_F(Followed, StopsOnThePathWhereItIsAsked) {
  open();
  for (int k = 0; k < 1000; ++k) step(pieces());
  follower_.stop();
  const int samples = run(pieces());
  EXPECT_EQ(follower_.end(), PathEnd::asked);
  EXPECT_LT(samples, 200);
  EXPECT_LT(off_, 1e-3);
}

/// A circle as fast as its centripetal acceleration allows, as hosts plan it: its stopping distance by the headroom
/// that the board computes from the geometry, not by the nodes' claims. core/path/README.md states the bound.
class StopOnACircle : public Followed {
 protected:
  /// Counts along the path from the request, at the highest speed, to rest; `u`: the centripetal share of the
  /// acceleration at that point, `x`: the share of the velocity.
  double way(double u, double x) {
    const double speed = x * kSpeed, radius = speed * speed / (u * kAcceleration);
    circle_ = {radius, std::round(1.875 * 2.0 * std::numbers::pi * radius / speed / kPiece) * kPiece};
    headroom_ = 0;
    open();
    hardest_ = off_ = 0.0;
    for (int k = 0; k < circle_.samples / 2; ++k) step(pieces());
    follower_.stop();
    double counts = 0.0;
    for (int k = 0; k < 2000 && follower_.is_moving(); ++k) {
      const double before[] = {group_[0].counts(), group_[1].counts()};
      step(pieces());
      counts += std::hypot(group_[0].counts() - before[0], group_[1].counts() - before[1]);
    }
    EXPECT_EQ(follower_.end(), PathEnd::asked);
    return counts;
  }
  static double bound(double u, double x) {
    const double change = firmware::PathClock::change_limit(kSpeed, kAcceleration, kJerk),
                 ramp = firmware::PathClock::ramp_limit(kSpeed, kJerk);
    const double left = std::min(0.97, 0.9 * std::sqrt(1.0 - u * u) / x), square = 1.0 / (1.0 - left);
    return x * kSpeed * (square / (2.0 * change) * std::log(1.0 / left) + change / ramp);
  }
};

TEST_F(StopOnACircle, TakesNoMoreThanIsStated) {
  for (const double u : {0.1, 0.3, 0.5, 0.7, 0.9, 0.96})
    for (const double x : {0.4, 0.8, 0.95}) {
      const double counts = way(u, x);
      EXPECT_LT(counts, bound(u, x)) << u << " " << x;
      EXPECT_LT(hardest_, 1.02) << "share of the acceleration limit, path and clock together";
      EXPECT_LT(off_, 1e-2);
    }
}

/// With the smallest possible headroom, the stopping distance was 2.5 times as long.
TEST_F(StopOnACircle, OfTheFastestKindTakesLittleMoreThanAStraightStop) {
  EXPECT_LT(way(0.96, 0.8), 1.5 * way(0.01, 0.8));
}

TEST_F(Followed, ClaimsBeyondTheGeometryAreRefused) {
  circle_ = {2000.0, 620.0};  // 0.72 of 0.8 at its fastest
  headroom_ = 15;
  open();
  const auto anywhere = [](std::size_t, std::int64_t) { return true; };
  Refusal refusal = Refusal::none;
  for (; refusal == Refusal::none && pushed_ < pieces() / 2; ++pushed_) {
    auto node = circle_.node(kPiece * (pushed_ + 1), kPiece, kUnits, false, given_);
    node.headroom_here = node.headroom_ahead = headroom_;
    refusal = follower_.push(node, false, anywhere);
  }
  EXPECT_EQ(refusal, Refusal::path_headroom);
}

/// 0 to `speed` in `samples`, without acceleration at either node: 1.5 times the mean acceleration in the middle.
TEST_F(Followed, NodesBeyondAnAxissLimitsAreRefusedWhenTheyCome) {
  const auto anywhere = [](std::size_t, std::int64_t) { return true; };
  const auto refusal = [&](double speed, int samples) {
    open();
    firmware::PathNode<kAxes> node;
    node.set_time(static_cast<std::uint32_t>(samples) << firmware::kPathTimeBits);
    node.axis[0] = {static_cast<std::int32_t>(std::lround(speed * samples / 2 * 65536)),
                    static_cast<std::int32_t>(std::lround(std::ldexp(speed, 24))), 0};
    return follower_.push(node, false, anywhere);
  };
  EXPECT_EQ(refusal(0.99 * kSpeed, 200), Refusal::none);
  EXPECT_EQ(refusal(1.05 * kSpeed, 200), Refusal::path_too_fast);
  EXPECT_EQ(refusal(30.0, 60), Refusal::none) << "0.75 of 0.8";
  EXPECT_EQ(refusal(30.0, 50), Refusal::path_too_fast) << "0.9 of 0.8";
}

/// Both nodes lie inside, but the path between them does not.
class TurnBetweenNodes : public Followed {
 protected:
  Refusal beyond(double end) {
    open();
    const auto inside = [](std::size_t, std::int64_t counts) { return counts >= -3000 && counts <= 3000; };
    const auto push = [&](int samples, double travel, double speed) {
      firmware::PathNode<kAxes> node;
      node.set_time(static_cast<std::uint32_t>(samples) << firmware::kPathTimeBits);
      node.axis[0] = {static_cast<std::int32_t>(std::lround(travel * 65536)),
                      static_cast<std::int32_t>(std::lround(std::ldexp(speed, 24))), 0};
      return follower_.push(node, false, inside);
    };
    const double sense = end > 0 ? 1.0 : -1.0;
    EXPECT_EQ(push(200, sense * 2500, sense * 25.0), Refusal::none);
    return push(300, 0, sense * -25.0);
  }
};

TEST_F(TurnBetweenNodes, BeyondOneEndIsRefused) { EXPECT_EQ(beyond(3000), Refusal::outside_travel); }
TEST_F(TurnBetweenNodes, BeyondTheOtherEndIsRefused) { EXPECT_EQ(beyond(-3000), Refusal::outside_travel); }

/// The other axes of a group are told of an axis's fault in their next step, and stop from their speed in that step.
TEST_F(Followed, LeadsOnForOneSampleWhenAnAxisLeaves) {
  open();
  for (int k = 0; k < 1000; ++k) step(pieces());
  const Increment speed = group_[1].increment;
  group_[0].held = firmware::SupervisorState::fault;
  step(pieces());
  EXPECT_EQ(follower_.end(), PathEnd::fault);
  EXPECT_TRUE(group_[1].is_led);
  EXPECT_EQ(group_[1].increment, speed);
}

TEST_F(Followed, RefusesWhatCannotBeRight) {
  const auto anywhere = [](std::size_t, std::int64_t) { return true; };
  firmware::PathNode<kAxes> node;
  node.duration = firmware::kShortestPiece;
  EXPECT_EQ(follower_.push(node, false, anywhere), Refusal::path_not_open);
  open();
  EXPECT_FALSE(follower_.start()) << "nothing to follow";
  node.duration = firmware::kShortestPiece - 1;
  EXPECT_EQ(follower_.push(node, false, anywhere), Refusal::path_too_fast);
  follower_.open(3, firmware::PathUnits{}, {}, {kLimits, kLimits});
  node.duration = firmware::kLongestPiece;
  node.axis[0].acceleration = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(follower_.push(node, false, anywhere), Refusal::path_too_fast) << "32 counts a sample^2, for 2^10 samples";
  open();
  node.duration = 10 * firmware::kShortestPiece;
  node.axis[0].acceleration = 0;
  node.axis[0].velocity = 1;
  EXPECT_EQ(follower_.push(node, true, anywhere), Refusal::path_ends_in_motion);
  EXPECT_EQ(follower_.push(node, false, [](std::size_t, std::int64_t) { return false; }), Refusal::outside_travel);
  for (std::size_t i = 0; i < Follower::kNodes; ++i) ASSERT_EQ(follower_.push(node, false, anywhere), Refusal::none);
  EXPECT_EQ(follower_.push(node, false, anywhere), Refusal::path_full);
}

}  // namespace
