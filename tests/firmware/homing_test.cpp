// The homing sequence alone, on an axis that responds at once.
#include "firmware/core/motion/homing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using firmware::AxisFault;
using firmware::HomingMode;
using firmware::HomingStep;

/// Counts are thousandths; a stop takes a few samples, as a ramp does.
struct Rail {
  firmware::HomingSequence<float> sequence;
  double place = 0.0, velocity = 0.0, wanted = 0.0;
  double switch_from = 500.0;  ///< actuated at and beyond it
  double index_spacing = 0.0;
  double fastest = 0.0;
  std::int64_t found = 0;

  static firmware::HomingParameters<float> parameters(HomingMode mode) { return {mode, 10.0F, 1.0F, 2000, 120, 0}; }

  /// Result of the sequence; fault none: home was found.
  AxisFault run(const firmware::HomingParameters<float>& parameters) {
    sequence.configure(parameters);
    EXPECT_TRUE(sequence.begin());
    for (int k = 0; k < 100'000; ++k) {
      const double before = place;
      velocity += std::min(2.0, std::max(-2.0, wanted - velocity));
      place += velocity;
      fastest = std::max(fastest, std::abs(velocity));
      firmware::HomingInputs seen;
      seen.counts = std::llround(place);
      seen.at_switch = place >= switch_from;
      seen.at_rest = velocity == 0.0 && wanted == 0.0;
      const double turn = index_spacing > 0.0 ? std::floor(place / index_spacing) : 0.0;
      if (index_spacing > 0.0 && turn != std::floor(before / index_spacing)) {
        seen.index_seen = true;
        seen.index_counts = std::llround(std::max(turn, std::floor(before / index_spacing)) * index_spacing);
      }
      const auto action = sequence.next(seen);
      if (action.step == HomingStep::jog) wanted = static_cast<double>(action.velocity);
      if (action.step == HomingStep::stop) wanted = 0.0;
      found = action.found;
      if (action.step == HomingStep::arrived) return AxisFault::none;
      if (action.step == HomingStep::failed) return action.fault;
    }
    ADD_FAILURE() << "the sequence does not end";
    return AxisFault::none;
  }
};

TEST(Homing, FindsTheSwitchAtCreepWhereverItBegins) {
  for (const double begin : {0.0, 495.0, 500.0, 800.0}) {
    Rail rail;
    rail.place = begin;
    EXPECT_EQ(rail.run(Rail::parameters(HomingMode::home_switch)), AxisFault::none) << begin;
    EXPECT_NEAR(static_cast<double>(rail.found), 500.0, 1.0) << begin;
    EXPECT_EQ(rail.velocity, 0.0);
    if (begin == 0.0) {
      EXPECT_GT(rail.fastest, 5.0) << "the search is faster than the creep";
    }
  }
}

TEST(Homing, TakesTheFirstIndexBehindTheSwitch) {
  Rail rail;
  rail.index_spacing = 70.0;  // pulses at 490, 560
  EXPECT_EQ(rail.run(Rail::parameters(HomingMode::switch_and_index)), AxisFault::none);
  EXPECT_EQ(rail.found, 560);
}

/// Pulses are multiples of the spacing; the switch acts at 500. Within an eighth of a turn of a pulse, on either side,
/// the switch is refused, and the distance to move it is reported.
TEST(Homing, RefusesASwitchThatActsNearAPulse) {
  struct Case {
    double spacing;
    AxisFault fault;
    double way;
  };
  for (const Case& c :
       {Case{63.0, AxisFault::homing_index_near_switch, 4.0}, Case{71.0, AxisFault::homing_index_near_switch, 68.0},
        Case{70.0, AxisFault::none, 60.0}, Case{51.0, AxisFault::none, 10.0}}) {
    Rail rail;
    rail.index_spacing = c.spacing;
    auto parameters = Rail::parameters(HomingMode::switch_and_index);
    parameters.turn = static_cast<std::int64_t>(c.spacing);
    EXPECT_EQ(rail.run(parameters), c.fault) << c.spacing;
    EXPECT_NEAR(static_cast<double>(rail.sequence.index_way()), c.way, 1.0) << c.spacing;
  }
}

TEST(Homing, ByTheIndexAloneCreepsToTheNext) {
  Rail rail;
  rail.place = 10.0;
  rail.index_spacing = 70.0;
  auto parameters = Rail::parameters(HomingMode::index);
  EXPECT_EQ(rail.run(parameters), AxisFault::none);
  EXPECT_EQ(rail.found, 70);
  EXPECT_LT(rail.fastest, 1.5);
  parameters.velocity = -10.0F;
  EXPECT_EQ(rail.run(parameters), AxisFault::none);
  EXPECT_EQ(rail.found, 70) << "from above, the same pulse";
}

TEST(Homing, WhatIsNeverFoundHasAName) {
  Rail without_switch;
  without_switch.switch_from = 1e9;
  EXPECT_EQ(without_switch.run(Rail::parameters(HomingMode::home_switch)), AxisFault::homing_switch_not_found);
  EXPECT_LT(without_switch.place, 2100.0) << "the travel is bounded";
  Rail stuck_switch;
  stuck_switch.switch_from = -1e9;
  EXPECT_EQ(stuck_switch.run(Rail::parameters(HomingMode::home_switch)), AxisFault::homing_travel_exceeded);
  EXPECT_GT(stuck_switch.place, -2100.0);
  Rail without_index;
  EXPECT_EQ(without_index.run(Rail::parameters(HomingMode::switch_and_index)), AxisFault::homing_index_not_found);
  EXPECT_LT(without_index.place, 500.0 + 130.0) << "a turn and a little more";
}

TEST(Homing, OfAnAxisWithNothingToFindDoesNotBegin) {
  Rail rail;
  rail.sequence.configure(Rail::parameters(HomingMode::none));
  EXPECT_FALSE(rail.sequence.begin());
}

}  // namespace
