// Counts between index pulses: lost counts are found, and correct ones cause no fault.
#include "firmware/core/supervision/index_monitor.hpp"

#include <gtest/gtest.h>

#include "tests/firmware/driven_axis.hpp"

namespace {

using firmware::AxisFault;
using firmware::IndexMonitor;

constexpr std::int32_t kSpacing = 4096;

/// A disc whose pulse is four counts wide; its rising edge is captured, whichever way it turns.
struct Disc {
  IndexMonitor monitor;
  std::int64_t place = 100;
  std::int64_t lost = 0;
  std::uint32_t origin = 0xFFFFF000u;  // the counter wraps on the way
  bool index_works = true;

  Disc() { monitor.configure(kSpacing); }
  std::uint32_t counter(std::int64_t at) const { return origin + static_cast<std::uint32_t>(at - lost); }
  static std::int64_t turn(std::int64_t at) { return at >= 0 ? at / kSpacing : (at + 1) / kSpacing - 1; }

  AxisFault move(std::int64_t by) {
    const std::int64_t before = turn(place);
    place += by;
    hal::IndexReading index;
    if (index_works && turn(place) != before)
      index = {counter(by > 0 ? turn(place) * kSpacing : turn(before * kSpacing) * kSpacing + 3), true, false};
    return monitor.watch(index, counter(place));
  }
  /// The first fault during the travel, in steps of `by`.
  AxisFault travel(std::int64_t way, std::int64_t by) {
    for (std::int64_t gone = 0; gone < way; gone += std::abs(by)) {
      const AxisFault found = move(by);
      if (found != AxisFault::none) return found;
    }
    return AxisFault::none;
  }
};

TEST(IndexSpacing, ASoundEncoderMayTurnAsItLikes) {
  Disc disc;
  EXPECT_EQ(disc.travel(50 * kSpacing, 137), AxisFault::none);
  EXPECT_EQ(disc.travel(70 * kSpacing, -211), AxisFault::none) << "backwards, through zero and the wrap";
  for (int k = 0; k < 200; ++k) {  // to and fro over one pulse
    EXPECT_EQ(disc.travel(500, 100), AxisFault::none);
    EXPECT_EQ(disc.travel(500, -100), AxisFault::none);
  }
  EXPECT_EQ(disc.travel(90 * kSpacing, 3 * kSpacing / 2), AxisFault::none) << "several pulses between two readings";
}

TEST(IndexSpacing, CountsLostOneByOneAddUp) {
  for (const int each : {1, -1}) {
    for (const std::int64_t by : {64, -64}) {
      Disc disc;
      int turns = 0;
      while (turns < 50 && disc.travel(kSpacing, by) == AxisFault::none) {
        disc.lost += each;
        ++turns;
      }
      EXPECT_GT(turns, IndexMonitor::kTolerance) << "within the tolerance";
      EXPECT_LT(turns, IndexMonitor::kTolerance + 4);
    }
  }
}

TEST(IndexSpacing, CountsLostAtOnceAreFoundWithinATurn) {
  Disc disc;
  ASSERT_EQ(disc.travel(3 * kSpacing, 64), AxisFault::none);
  disc.lost = 20;
  EXPECT_EQ(disc.travel(kSpacing + 64, 64), AxisFault::index_mismatch);
}

TEST(IndexSpacing, ATurnWithoutAPulseIsADeadLine) {
  for (const std::int64_t by : {64, -64}) {
    Disc disc;
    disc.index_works = false;
    EXPECT_EQ(disc.travel(kSpacing - 64, by), AxisFault::none);
    EXPECT_EQ(disc.travel(256, by), AxisFault::index_mismatch);
  }
}

TEST(IndexSpacing, IsWatchedOnAnAxisThatMoves) {
  for (const std::int32_t spacing : {2048, 2000}) {
    auto p = firmware_test::parameters_of<float>(firmware_test::kPaperX);
    p.monitors.index_spacing = spacing;
    firmware_test::DrivenAxis axis(p);
    ASSERT_TRUE(axis.axis.jog(100.0f));
    std::int64_t last_turn = 0;
    for (int k = 0; k < 1000; ++k) {
      axis.step();
      const auto counts = static_cast<std::int32_t>(axis.io.encoder().reading.counts);
      const std::int64_t turn = Disc::turn(2 * std::int64_t{counts});  // a disc with 2048 counts
      if (turn != last_turn) axis.io.encoder().index = {static_cast<std::uint32_t>(turn * 2048), true, false};
      last_turn = turn;
    }
    EXPECT_EQ(axis.axis.fault(), spacing == 2048 ? AxisFault::none : AxisFault::index_mismatch);
    EXPECT_EQ(axis.axis.is_homed(), spacing == 2048) << "lost counts invalidate home";
  }
}

}  // namespace
