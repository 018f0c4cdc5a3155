// Prior probability of a period.
#include "host/effort/effort_waves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

std::vector<double> priors(const std::vector<host::Wave>& waves, const sim::DataSheet& data) {
  std::vector<double> shares = host::log_priors(waves, data);
  for (double& share : shares) share = std::exp(share);
  return shares;
}

TEST(EffortWaves, TheTurnHasHalfOfThePriorByOneOverTheOrder) {
  sim::DataSheet screw;
  screw.lead = 10.0 / (2.0 * std::numbers::pi);
  const double turn = screw.turn();
  const std::vector<double> shares = priors({{turn, 1.0}, {turn, 2.0}, {turn, 4.0}, {3.3, 1.0}, {4.4, 1.0}}, screw);
  EXPECT_NEAR(shares[0], 0.5 / 1.75, 1e-12);
  EXPECT_NEAR(shares[1], shares[0] / 2.0, 1e-12);
  EXPECT_NEAR(shares[2], shares[0] / 4.0, 1e-12);
  EXPECT_NEAR(shares[3], 0.25, 1e-12);
  EXPECT_NEAR(shares[4], 0.25, 1e-12);
}

TEST(EffortWaves, WithoutATurnAllPeriodsAreAlike) {
  sim::DataSheet linear;
  linear.kind = sim::DriveKind::linear;
  for (const double share : priors({{0.02, 1.0}, {0.03, 1.0}, {0.05, 1.0}, {0.07, 1.0}}, linear))
    EXPECT_NEAR(share, 0.25, 1e-12);
}

}  // namespace
