#include "host/compare/chance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

TEST(Chance, AnImprovementInEveryWindowIsCertain) {
  const std::vector<double> before(400, 4.0), after(400, 1.0);
  EXPECT_EQ(host::confidence_of_improvement(before, after), 1.0);
  EXPECT_EQ(host::confidence_of_improvement(after, before), 0.0);
}

TEST(Chance, NoChangeIsNoImprovement) {
  const std::vector<double> same(400, 4.0);
  EXPECT_EQ(host::confidence_of_improvement(same, same), 0.0);
  EXPECT_EQ(host::confidence_of_improvement({}, {}), 0.0);
}

TEST(Chance, NoiseThatSumsToNothingIsEvenOdds) {
  // Every gain occurs with both signs, so that the sum is zero and the bootstrap distribution is symmetric.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> gain(0.1, 1.0);
  std::vector<double> before, after;
  for (int block = 0; block < 100; ++block)
    for (const double sign : {1.0, -1.0}) {
      const double size = gain(random);
      for (int k = 0; k < 10; ++k) {
        before.push_back(5.0 + sign * size);
        after.push_back(5.0);
      }
    }
  // 2000 draws give a standard deviation of 0.011; the tolerance is four of them.
  EXPECT_NEAR(host::confidence_of_improvement(before, after, 10), 0.5, 0.045);
}

TEST(Chance, OneLuckyBlockIsNotConfidence) {
  // A tenth worse in all blocks except one in 400, which outweighs the others. This block is absent in 1/e of the
  // resampled sets.
  std::vector<double> before(4000, 1.0), after(4000, 1.01);
  for (std::size_t k = 0; k < 10; ++k) before[k] = 1000.0;
  const double confidence = host::confidence_of_improvement(before, after);
  EXPECT_NEAR(confidence, 1.0 - 1.0 / std::exp(1.0), 0.045);
}

}  // namespace
