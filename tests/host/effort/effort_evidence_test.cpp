// Records written down in closed form (made_effort.hpp).
#include "host/effort/effort_evidence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/compare/comparison.hpp"
#include "tests/host/effort/made_effort.hpp"

namespace {

using testing::Contains;
using testing::IsEmpty;

template <typename Further>
host::EffortEvidence weighed(Further further) {
  const host::Record train = record_of(slow_turning, further, 0.0, 20.0, 1);
  const host::Record validate = record_of(slow_turning, further, 31.0, 45.0, 2);
  const auto found =
      host::weigh_effects(motor(), host::compare_on({&train}, motor()), host::compare_on({&validate}, motor()));
  EXPECT_TRUE(found.has_value());
  return found.value_or(host::EffortEvidence{});
}

}  // namespace

TEST(EffortEvidence, ClaimsNothingWhereNothingIsMissing) {
  const host::EffortEvidence found = weighed([](const Point&) { return 0.0; });
  EXPECT_THAT(found.effects(), IsEmpty());
  EXPECT_GT(found.nothing, 0.5);
}

TEST(EffortEvidence, NamesCoggingOfTwoOrders) {
  const host::EffortEvidence found =
      weighed([](const Point& point) { return 0.01 * std::cos(7.0 * point.x) + 0.005 * std::sin(12.0 * point.x); });
  ASSERT_THAT(found.effects(), Contains("cogging"));
  EXPECT_EQ(found.certain.front().group, std::vector<std::string>{"cogging"});
  EXPECT_GE(found.certain.front().probability, 0.95);
  const sim::EffectEntry& cogging = *found.best.model.find("cogging");
  EXPECT_NEAR(cogging.at("period"), kTurn, 0.01);
  EXPECT_NEAR(std::abs(cogging.at("cosine_7")), 0.01, 0.001);
  EXPECT_NEAR(std::abs(cogging.at("sine_12")), 0.005, 0.001);
}

TEST(EffortEvidence, CannotTellAWeightFromAnOffset) {
  const host::EffortEvidence found = weighed([](const Point&) { return 0.008; });
  ASSERT_FALSE(found.certain.empty());
  EXPECT_THAT(found.certain.front().group, Contains("constant_torque"));
  EXPECT_THAT(found.certain.front().group, Contains("dac_offset"));
  EXPECT_LT(found.certain.front().after, 0.5 * found.certain.front().before);
}

TEST(EffortEvidence, GivesABumpThatNoEffectIsToTheMemory) {
  const host::EffortEvidence found =
      weighed([](const Point& point) { return 0.015 * std::exp(-0.5 * std::pow(point.x - 3.0, 2)); });
  EXPECT_THAT(found.effects(), IsEmpty());
  EXPECT_GT(found.memory_log_odds, 10.0);
}
