// Motion of the axes while the path clock slows down and speeds up: in feed holds, with overrides, and when nodes are
// missing.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "host/path/path_words.hpp"
#include "tests/host/path/random_programs.hpp"

namespace {

using namespace path_test;  // NOLINT(google-build-using-namespace)

enum class Disturbance { hold, override, starvation };

/// A path with the axes' limits and the clock's shares of them, as opened on the board (PathService::open).
struct Disturbed {
  std::vector<PathPoint> points{3, PathPoint::Zero()};
  firmware::PathEnd end = firmware::PathEnd::none;
  int longest_stop = 0;  ///< longest stop in samples, for holds that were not resumed
};
Disturbed run(const host::PlannedPath& path, Disturbance what, std::mt19937_64& numbers) {
  const host::PathScale scale{{0, 1}, {kCount_mm, kCount_mm}, {1.0, 1.0}, kRate_Hz};
  const host::PathWords words = path_words(path, scale, units_of(path, scale), {{}, {}});
  auto follower = std::make_unique<firmware::PathFollower<2, 400>>();
  follower->open(3, words.units, {}, {board_limits(), board_limits()});
  follower->override_rate(firmware::kOneCount);
  LedAxes axes;
  Disturbed seen;
  std::size_t sent = 0;
  // Starving: only this many nodes arrive.
  const std::size_t most_nodes =
      what == Disturbance::starvation ? 1 + numbers() % words.nodes.size() : words.nodes.size();
  std::uniform_int_distribution<int> pause(1, 600);
  int until_next = pause(numbers);
  bool held = false;
  int held_at = 0;
  for (int k = 0; k < 400'000 && (k == 0 || follower->is_moving()); ++k) {
    for (; sent < most_nodes && follower->room() > 0; ++sent) {
      const auto& word = words.nodes[sent];
      EXPECT_EQ(
          follower->push(node_of(word), sent + 1 == words.nodes.size(), [](std::size_t, std::int64_t) { return true; }),
          firmware::Refusal::none);
    }
    follower->prepare();
    if (k == 0) follower->start();
    if (--until_next == 0) {
      until_next = pause(numbers);
      held = !held;
      held_at = k;
      if (what == Disturbance::hold) follower->hold(held);
      if (what == Disturbance::override)
        follower->override_rate(firmware::kOneCount / 8 * static_cast<int>(1 + numbers() % 8));
    }
    if (what == Disturbance::hold && held && follower->rate() > 0)
      seen.longest_stop = std::max(seen.longest_stop, k - held_at);
    follower->before_step(axes);
    seen.points.emplace_back(axes[0].mm(), axes[1].mm(), 0.0);
  }
  seen.points.insert(seen.points.end(), 3, seen.points.back());
  seen.end = follower->end();
  return seen;
}

class ThePathClock : public testing::TestWithParam<Disturbance> {};

/// Catches a clock that runs backwards, one that ignores the path's own share of an axis's limits, and one that does
/// not stop in time: along the bound of its change with the smallest headroom, and three of its ramps.
/// AXIS_PATH_PROGRAMS=10000 runs more programs (`make soak`).
TEST_P(ThePathClock, HoldsTheAxesLimitsAndLeavesNoPath) {
  const int programs = path_test::programs_to_try();
  Seen worst;
  int longest_stop = 0;
  for (int seed = 1; seed <= programs && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 numbers(static_cast<std::uint64_t>(seed));
    const auto moves = random_program(numbers);
    const Disturbed done = run(plan_path(moves, options()), GetParam(), numbers);
    const Seen seen = look_at(done.points, moves);
    EXPECT_LE(seen.velocity, 1.0 + 1e-6);
    longest_stop = std::max(longest_stop, done.longest_stop);
    EXPECT_LE(seen.off_counts, 1.0 + moves.front().tolerance_mm / kCount_mm);
    worst = {std::max(worst.velocity, seen.velocity), std::max(worst.acceleration, seen.acceleration),
             std::max(worst.jerk, seen.jerk), std::max(worst.off_counts, seen.off_counts)};
    if (GetParam() != Disturbance::starvation) {
      EXPECT_EQ(done.end, firmware::PathEnd::completed);
      EXPECT_LT((done.points.back() - moves.back().curve.end()).norm(), 0.5 * kCount_mm);
    }
  }
  EXPECT_LE(worst.acceleration, 1.0 + 1e-4);
  EXPECT_LE(worst.jerk, 1.0 + 5e-3) << "as paths alone: a rounding of 2^-16 counts is 1e-3 of it";
  const double change = firmware::PathClock::change_limit(kVelocity, kAcceleration, kJerk);
  const double ramp = firmware::PathClock::ramp_limit(kVelocity, kJerk);
  EXPECT_LT(longest_stop, (std::atanh(1.0 / firmware::kLeastHeadroom) / change + 3.0 * change / ramp) * kRate_Hz);
  RecordProperty("longest_stop", longest_stop);
  RecordProperty("worst_acceleration", std::to_string(worst.acceleration));
  RecordProperty("worst_jerk", std::to_string(worst.jerk));
}

INSTANTIATE_TEST_SUITE_P(Disturbed, ThePathClock,
                         testing::Values(Disturbance::hold, Disturbance::override, Disturbance::starvation));

}  // namespace
