#include <gtest/gtest.h>

#include "host/commission/steps.hpp"
#include "tests/host/commission/own_machine.hpp"

namespace {

sim::DriveDescription with_static(double positive, std::array<double, 2> interval) {
  sim::DriveDescription model = own_sheet();  // 3.15 Nm/V
  model.effects.push_back({"coulomb", {{"positive", 2.1}, {"negative", -2.1}}, {}, {}});
  model.effects.push_back({"stribeck",
                           {{"static_positive", positive},
                            {"omega1_positive", 0.045},
                            {"omega2_positive", 0.17},
                            {"static_negative", -2.3},
                            {"omega1_negative", -0.8},
                            {"omega2_negative", -0.3}},
                           {{"static_positive", interval}, {"static_negative", {-2.4, -2.2}}},
                           "ladder.csv"});
  return model;
}

/// Catches a distorted friction curve of a cogging axis, which leads to a nonexistent weight.
TEST(StaticFriction, IsWhatBrokeTheAxisAwayWhereTheJogsLeaveItOpen) {
  sim::DriveDescription model = with_static(79.0, {-237.0, 395.0});
  EXPECT_TRUE(host::level_static_friction(model, 0.8, 0.9));
  const sim::EffectEntry& found = *model.find("stribeck");
  EXPECT_DOUBLE_EQ(found.at("static_positive"), 0.8 * 3.15);
  EXPECT_DOUBLE_EQ(found.at("omega1_positive"), 0.17);
  EXPECT_FALSE(found.ci95.contains("static_positive"));
  EXPECT_DOUBLE_EQ(found.at("static_negative"), -2.3);
  EXPECT_DOUBLE_EQ(found.at("omega1_negative"), -0.8);
}

TEST(StaticFriction, StaysWhereTheJogsDecideIt) {
  sim::DriveDescription model = with_static(2.4, {2.2, 2.6});
  EXPECT_FALSE(host::level_static_friction(model, 0.8, 0.9));
  EXPECT_DOUBLE_EQ(model.find("stribeck")->at("static_positive"), 2.4);
}

}  // namespace
