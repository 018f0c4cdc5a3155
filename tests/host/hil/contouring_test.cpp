// Section 4 of the paper: the circle without and with friction feed-forward, and with on-line cancellation.
#include "host/hil/contouring.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/exit_codes.hpp"
#include "host/hil/commissioning.hpp"
#include "host/identify/paper_drives.hpp"

namespace {

using host::Path;

constexpr std::uint64_t kSeed = 3;

/// Identified once: the controller uses the identified values of the plants, not Table 1.
const std::array<sim::DriveDescription, 2>& identified() {
  static const std::array<sim::DriveDescription, 2> models{host::commission(*host::paper_drive("x"), 1),
                                                           host::commission(*host::paper_drive("y"), 2)};
  return models;
}

host::ContouringRun circle(const host::CompensationSwitches& switches, std::uint64_t seed = kSeed) {
  std::array<host::MachineAxis, 2> axes;
  for (std::size_t i = 0; i < 2; ++i) {
    axes[i].drive = *host::paper_drive(host::kAxisNames[i]);
    axes[i].parameters = host::contouring_parameters(identified()[i], switches);
  }
  return host::run_contour(axes, Path::circle(35.0), {}, seed);
}

void print(const char* name, const host::ContouringRun& run) {
  std::printf("%-24s contour %5.1f um, tracking %5.1f and %5.1f um, standing %4.1f before, %4.1f after\n", name,
              run.worst_contour_um(), run.worst_tracking_um(0), run.worst_tracking_um(1), run.standing_before_um(),
              run.standing_after_um());
}

constexpr double kCount_um = 1e4 / 4096.0;

TEST(Circle, WithoutFrictionFeedforwardStraysAsThePapersMachineDid) {
  const auto run = circle({});
  print("feedback alone", run);
  EXPECT_GE(run.worst_contour_um(), 17.0);
  EXPECT_LE(run.worst_contour_um(), 25.0);
  EXPECT_GT(run.standing_before_um(), 2.0 * kCount_um);
  EXPECT_GT(run.standing_after_um(), 2.0 * kCount_um);
}

TEST(Circle, WithFrictionFeedforwardKeepsToThePath) {
  const auto run = circle({.friction = true, .cancellation = false});
  print("friction feed-forward", run);
  EXPECT_LE(run.worst_contour_um(), 5.0);
  EXPECT_LE(run.standing_before_um(), kCount_um);
  EXPECT_LE(run.standing_after_um(), kCount_um);
}

/// If the friction curve is right, cancellation adds only the noise of the estimate. That noise decides where each axis
/// stands, and where it falls on a reversal, the error is twice as large. So the median of many seeds counts.
TEST(Circle, CancellationOnTopCostsLittleWhereTheModelIsRight) {
  constexpr std::uint64_t kSeeds = 51;
  std::vector<double> worst_um;
  int within_a_count = 0;
  for (std::uint64_t seed = kSeed; seed < kSeed + kSeeds; ++seed) {
    const auto run = circle({.friction = true, .cancellation = true}, seed);
    worst_um.push_back(run.worst_contour_um());
    if (run.standing_after_um() <= kCount_um) ++within_a_count;
    EXPECT_LE(run.standing_after_um(), 2.0 * kCount_um) << "seed " << seed;
  }
  std::ranges::sort(worst_um);
  const double median_um = worst_um[kSeeds / 2];
  std::printf("with cancellation: contour %.1f to %.1f um, median %.1f um; %d of %d stand within a count\n",
              worst_um.front(), worst_um.back(), median_um, within_a_count, static_cast<int>(kSeeds));
  EXPECT_LE(median_um, circle({}).worst_contour_um() / 3.0);
}

TEST(Path, ACircleIsFollowedToItsEndWithinTheLimits) {
  const host::PathLimits limits;
  const double count_mm = 10.0 / 4096.0;
  const auto steps = host::follow_path(Path::circle(35.0), limits, 1e-3, {count_mm, count_mm});
  std::array<double, 2> position{}, last{};
  double fastest = 0.0;
  for (const auto& step : steps) {
    for (std::size_t i = 0; i < 2; ++i) {
      last[i] = static_cast<double>(step[i]) / static_cast<double>(firmware::kOneCount) * count_mm;
      position[i] += last[i];
    }
    fastest = std::max(fastest, std::hypot(last[0], last[1]) * 1e3);
    EXPECT_NEAR(std::hypot(position[0] - 35.0, position[1]), 35.0, 1e-6);
  }
  EXPECT_NEAR(position[0], 0.0, 1e-6);
  EXPECT_NEAR(position[1], 0.0, 1e-6);
  EXPECT_NEAR(fastest, 170.0, 0.1);  // due to a whole number of samples, and chords instead of arcs
  // Length over feed, plus the time for acceleration and deceleration: v/a + a/j.
  const double duration_s = 2.0 * std::numbers::pi * 35.0 / 170.0 + 170.0 / 2000.0 + 2000.0 / 50'000.0;
  EXPECT_NEAR(static_cast<double>(steps.size()) * 1e-3, duration_s, 0.003);
}

/// 800,000 counts are 2^67 increments, so absolute positions do not fit 64 bits.
TEST(Path, AWideCircleIsFollowedToItsEnd) {
  const double count_mm = 10.0 / 4096.0;
  const auto steps = host::follow_path(Path::circle(1000.0), {}, 1e-3, {count_mm, count_mm});
  std::array<firmware::CountPosition, 2> position{};
  double farthest_mm = 0.0;
  for (const auto& step : steps) {
    for (std::size_t i = 0; i < 2; ++i) position[i].advance(step[i]);
    farthest_mm = std::max(farthest_mm, static_cast<double>(position[0].counts) * count_mm);
  }
  EXPECT_NEAR(farthest_mm, 2000.0, 2 * count_mm);
  for (const auto& axis : position) EXPECT_EQ(axis.counts + (axis.fraction > firmware::kOneCount / 2 ? 1 : 0), 0);
}

TEST(Path, StepsBeyondTheReferencesRangeAreRefused) {
  EXPECT_THROW(host::follow_path(Path::circle(35.0), {}, 1e-3, {1e-7, 1e-7}), host::Failure);
}

TEST(Path, ARoundedSquareIsClosedAndSmooth) {
  const Path square = Path::rounded_square(40.0, 8.0);
  EXPECT_NEAR(square.length(), 4.0 * 24.0 + 2.0 * std::numbers::pi * 8.0, 1e-9);
  host::PlanePoint last = square.at(0.0);
  for (double s = 0.05; s <= square.length(); s += 0.05) {
    const host::PlanePoint now = square.at(s);
    EXPECT_NEAR(std::hypot(now.x - last.x, now.y - last.y), 0.05, 1e-4) << s;
    EXPECT_NEAR(square.distance_to(now), 0.0, 1e-9) << s;
    last = now;
  }
  EXPECT_NEAR(square.distance_to({0.0, 3.0}), 3.0, 1e-9);
  EXPECT_NEAR(square.distance_to({20.0, 0.0}), std::hypot(8.0, 8.0) - 8.0, 1e-9);
}

}  // namespace
