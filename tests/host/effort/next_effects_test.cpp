// Probabilities of the candidates for the next effect, from their log odds.
#include "host/effort/next_effects.hpp"

#include <gmock/gmock.h>

#include "host/infer/posterior.hpp"

namespace {

host::NextEffect candidate(const std::string& kind, double log_weight) {
  host::EffortTerm term;
  term.kind = kind;
  return {.term = std::move(term), .others = {}, .log_odds = log_weight, .log_weight = log_weight};
}

host::NextEffects weighed(std::vector<host::NextEffect> effects) {
  host::NextEffects next{.effects = std::move(effects), .log_nothing = std::log(host::kNothingMore), .fit = {}};
  host::renew_probabilities(next);
  return next;
}

TEST(NextEffects, WhatIsTakenOutHandsItsProbabilityOnHoweverFarItLed) {
  host::NextEffects next = weighed({candidate("cogging", 2640.0), candidate("nonlinear_viscous", 270.0)});
  EXPECT_EQ(next.effects.back().probability, 0.0) << "exp(-2370) is no double";
  host::take_out(next, {"cogging"});
  double probability = 0.0;
  EXPECT_THAT(host::certain_group(next, probability), testing::ElementsAre("nonlinear_viscous"));
  EXPECT_GT(probability, 0.999);
  EXPECT_LT(next.nothing, 1e-9);
}

TEST(NextEffects, AnEffectWithoutANameCountsAsNoneOfTheCatalogue) {
  host::NextEffects next = weighed({candidate(host::kNoName, 30.0), candidate("cogging", 20.0)});
  host::leave_unnamed(next);
  ASSERT_EQ(next.effects.size(), 1U);
  EXPECT_NEAR(next.nothing, 1.0 / (1.0 + std::exp(-10.0)), 1e-6);
}

TEST(NextEffects, AKindInPlaceOfAnotherHasTheProbabilityOfBoth) {
  host::NextEffects next =
      weighed({candidate("backlash", 12.0), candidate("compliance", 11.0), candidate("cogging", 8.0)});
  const double both = next.effects[0].probability + next.effects[1].probability;
  host::give_place(next, "backlash", candidate("compliance", 0.0));
  ASSERT_EQ(next.effects.size(), 2U);
  EXPECT_EQ(next.effects.front().term.kind, "compliance");
  EXPECT_NEAR(next.effects.front().probability, both, 1e-12);
}

}  // namespace
