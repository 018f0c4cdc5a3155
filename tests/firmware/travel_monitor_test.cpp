// Ends of travel by the encoder's motion, independent of the reference.
#include "firmware/core/supervision/travel_monitor.hpp"

#include <gtest/gtest.h>

#include "tests/firmware/paper_axes.hpp"

namespace {

using firmware::AxisFault;

class Travel : public testing::Test {
 protected:
  Travel() {
    auto p = firmware_test::parameters_of<float>(firmware_test::kPaperX);
    p.monitors.travel_min_counts = -1000;
    p.monitors.travel_max_counts = 2000;
    p.monitors.input_samples = 1;
    play = firmware::TravelMonitor<float>::play_in_counts(p);
    monitor.configure(p, 0);
  }
  AxisFault at(std::int64_t counts, float reference_velocity = 0.0f) {
    firmware::AxisTelemetry<float> seen;
    seen.encoder_counts = counts;
    seen.homed = true;
    seen.reference_velocity = reference_velocity;
    return monitor.watch(seen, switches);
  }

  firmware::TravelMonitor<float> monitor;
  hal::LimitState switches;
  std::int64_t play = 0;
};

TEST_F(Travel, PlayIsAQuarterOfTheFollowingError) { EXPECT_EQ(play, 2 + 51); }  // 0.5 mm / 4 / 2.44 um

TEST_F(Travel, AnAxisThatIsPushedOntoASwitchAtStandstillIsFound) {
  EXPECT_EQ(at(1500), AxisFault::none);
  switches.positive_end = true;
  EXPECT_EQ(at(1501), AxisFault::none);
  EXPECT_EQ(at(1501 + play), AxisFault::none);
  EXPECT_EQ(at(1501 + play + 1), AxisFault::limit_switch_positive);
}

TEST_F(Travel, AnAxisThatRunsAwayBeyondItsTravelIsFoundAlthoughItsReferenceLeadsBack) {
  EXPECT_EQ(at(-1001, 1.0f), AxisFault::none);
  EXPECT_EQ(at(-1001 - play - 1, 1.0f), AxisFault::travel_limit);
}

TEST_F(Travel, TheWayBackIsFreeAndEveryStepOfItIsKept) {
  switches.positive_end = true;
  for (std::int64_t counts = 1900; counts > 1500; counts -= 10) ASSERT_EQ(at(counts, -1.0f), AxisFault::none) << counts;
  EXPECT_EQ(at(1510 + play), AxisFault::none);
  EXPECT_EQ(at(1510 + play + 1), AxisFault::limit_switch_positive);
}

TEST_F(Travel, LeavingTheSwitchForgetsTheWay) {
  switches.negative_end = true;
  EXPECT_EQ(at(-100), AxisFault::none);
  switches.negative_end = false;
  EXPECT_EQ(at(-50), AxisFault::none);
  switches.negative_end = true;
  EXPECT_EQ(at(-400), AxisFault::none) << "actuated anew";
}

TEST_F(Travel, AReferenceThatLeadsOutIsStoppedAtOnce) {
  switches.negative_end = true;
  EXPECT_EQ(at(0, -0.1f), AxisFault::limit_switch_negative);
  switches.negative_end = false;
  EXPECT_EQ(at(2001, 0.1f), AxisFault::travel_limit);
}

}  // namespace
