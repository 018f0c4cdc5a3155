// Comparison of verdicts with the truth, and of forecasts with the outcome.
#include "host/scoreboard/answer.hpp"

#include <gtest/gtest.h>

namespace {

using host::Outcome;
using host::Status;

host::DiagnosisVerdict verdict(Status status, std::vector<std::string> effects = {}) {
  host::DiagnosisVerdict verdict;
  verdict.status = status;
  verdict.effects = std::move(effects);
  return verdict;
}

TEST(Outcomes, AreWhatTheTruthMakesOfAnAnswer) {
  const host::Truth cogging{{"cogging"}}, both{{"cogging", "backlash"}}, nothing, alien{{}, true};
  EXPECT_EQ(host::outcome_of(cogging, verdict(Status::missing, {"cogging"})), Outcome::right);
  EXPECT_EQ(host::outcome_of(cogging, verdict(Status::missing, {"backlash"})), Outcome::wrong);
  EXPECT_EQ(host::outcome_of(cogging, verdict(Status::ambiguous, {"backlash", "cogging"})), Outcome::group);
  EXPECT_EQ(host::outcome_of(cogging, verdict(Status::ambiguous, {"backlash", "presliding"})), Outcome::wrong);
  EXPECT_EQ(host::outcome_of(cogging, verdict(Status::adequate)), Outcome::missed);
  EXPECT_EQ(host::outcome_of(both, verdict(Status::missing, {"backlash", "cogging"})), Outcome::right);
  EXPECT_EQ(host::outcome_of(both, verdict(Status::missing, {"backlash"})), Outcome::partly);
  host::DiagnosisVerdict either = verdict(Status::missing, {"cogging", "presliding"});
  EXPECT_EQ(host::outcome_of(both, either), Outcome::wrong);
  either.alternatives = {{"presliding", "backlash"}};
  EXPECT_EQ(host::outcome_of(both, either), Outcome::group);
  EXPECT_EQ(host::outcome_of(cogging, either), Outcome::wrong);
  host::DiagnosisVerdict beside = verdict(Status::missing, {"cogging"});
  beside.alternatives = {{"presliding", "backlash"}};
  EXPECT_EQ(host::outcome_of(both, beside), Outcome::group);
  EXPECT_EQ(host::outcome_of(cogging, beside), Outcome::partly);
  EXPECT_EQ(host::outcome_of(nothing, verdict(Status::parameters)), Outcome::right);
  EXPECT_EQ(host::outcome_of(nothing, verdict(Status::missing, {"cogging"})), Outcome::wrong);
  EXPECT_EQ(host::outcome_of(alien, verdict(Status::unexplained)), Outcome::right);
  EXPECT_EQ(host::outcome_of(alien, verdict(Status::insufficient_data)), Outcome::right);
  EXPECT_EQ(host::outcome_of(alien, verdict(Status::adequate)), Outcome::wrong);
  EXPECT_EQ(host::outcome_of(alien, verdict(Status::missing, {"cogging"})), Outcome::wrong);
}

TEST(Reliability, IsPerfectWhereForecastsComeTrueAsOftenAsTheySay) {
  std::vector<host::Forecast> forecasts;
  for (int k = 0; k < 10; ++k) forecasts.emplace_back(0.3, k < 3);
  EXPECT_NEAR(host::reliability_of(forecasts).expected_error, 0.0, 1e-12);
}

TEST(Reliability, CountsEachBinByItsForecasts) {
  // Nine at 95 % that never come true, one at 5 % that does not either.
  std::vector<host::Forecast> forecasts(9, {0.95, false});
  forecasts.emplace_back(0.05, false);
  const host::Reliability reliability = host::reliability_of(forecasts);
  EXPECT_NEAR(reliability.expected_error, 0.9 * 0.95 + 0.1 * 0.05, 1e-12);
  EXPECT_EQ(reliability.bins[9].count, 9U);
  EXPECT_EQ(reliability.bins[0].count, 1U);
}

TEST(Reliability, KeepsACertainForecastInTheLastBin) {
  EXPECT_EQ(host::reliability_of({{1.0, true}}).bins.back().count, 1U);
}

}  // namespace
