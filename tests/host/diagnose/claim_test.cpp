// Criteria for a claim, on errors written by hand.
#include "host/diagnose/claim.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "host/compare/chance.hpp"
#include "host/diagnose/probability.hpp"
#include "host/diagnose/verdict.hpp"
#include "host/search/physical_range.hpp"
#include "tests/host/diagnose/sum_of_probabilities.hpp"
#include "tests/host/evidence/hand_made_record.hpp"

namespace {

using host::Reservation;

host::JudgedCandidate candidate(double before, double after, double train_after) {
  host::JudgedCandidate judged;
  judged.kinds = {"viscous_asymmetry"};
  judged.before = before;
  judged.after = after;
  judged.train_after = train_after;
  judged.level = {train_after, after};
  judged.confidence = 1.0;
  judged.luck = 0.001;
  judged.model = HandMade::model();
  judged.model.effects.push_back({"viscous_asymmetry", {{"asymmetry", 0.01}}, {}, {}});
  return judged;
}

host::Diagnosis diagnosis(double before_train, double before_validate) {
  host::Diagnosis result;
  result.before_train = before_train;
  result.before_validate = before_validate;
  result.base_level = {before_train, before_validate};
  return result;
}

TEST(Claim, WhatTakesNearlyAllOfTheErrorOnBothSetsStands) {
  EXPECT_EQ(host::reservation_about(candidate(12.0, 1.0, 1.1), diagnosis(20.0, 12.0)), Reservation::none);
  // A slightly late impact leaves 3 of 20 noise floors on training: 2 % of the squared error.
  EXPECT_EQ(host::reservation_about(candidate(12.0, 1.0, 3.0), diagnosis(20.0, 12.0)), Reservation::none);
}

TEST(Claim, ACompleteModelLeavesNothingToExplain) {
  // A gain by chance on validation data, in which a few windows are bad. The training data had no error to explain.
  EXPECT_EQ(host::reservation_about(candidate(1.24, 0.97, 0.76), diagnosis(0.83, 1.24)), Reservation::no_gain);
  EXPECT_EQ(host::reservation_about(candidate(1.05, 0.8, 0.8), diagnosis(1.05, 1.05)), Reservation::no_gain);
}

TEST(Claim, ASetAtItsNoiseFloorHasNothingLeftForAFurtherEffect) {
  EXPECT_NEAR(host::explained_beyond(candidate(14.0, 2.0, 0.93), candidate(14.0, 1.9, 0.77)), 0.1, 1e-9);
  EXPECT_NEAR(host::explained_beyond(candidate(14.0, 2.0, 2.0), candidate(14.0, 1.0, 1.0)), 1.0, 1e-9);
}

TEST(Claim, WhatLowersOneSetOnlyIsNoFinding) {
  EXPECT_EQ(host::reservation_about(candidate(12.0, 1.0, 20.5), diagnosis(20.0, 12.0)), Reservation::no_gain);
  EXPECT_EQ(host::reservation_about(candidate(12.0, 12.5, 1.0), diagnosis(20.0, 12.0)), Reservation::no_gain);
}

// Friction that grows with the transmitted torque had this result beside a hysteresis: most windows are predicted
// better, and a few so much worse that the error doubles.
TEST(Claim, WhatHelpsMostWindowsAndRaisesTheErrorIsNoFinding) {
  host::Diagnosis rough = diagnosis(38.0, 22.0);
  rough.rough = true;
  host::JudgedCandidate judged = candidate(22.0, 49.6, 99.0);
  judged.level = {5.0, 5.0};
  EXPECT_EQ(host::reservation_about(judged, rough), Reservation::no_gain);
  EXPECT_EQ(host::explained_by(judged, rough), 0.0);
}

TEST(Claim, WhatLeavesAThirdOfTheErrorMakesUpForSomethingElse) {
  EXPECT_EQ(host::reservation_about(candidate(4.0, 2.4, 1.0), diagnosis(4.0, 4.0)), Reservation::leaves_much);
  host::Diagnosis rough = diagnosis(40.0, 40.0);
  rough.rough = true;  // the machine is limited by model error
  EXPECT_EQ(host::reservation_about(candidate(40.0, 20.0, 20.0), rough), Reservation::none);
}

TEST(Claim, AParameterAtTheEndOfItsRangeIsNoFinding) {
  host::JudgedCandidate judged = candidate(12.0, 1.0, 1.0);
  judged.on_bound = {"compliance: damping_ratio"};
  EXPECT_EQ(host::reservation_about(judged, diagnosis(20.0, 12.0)), Reservation::on_bound);
}

TEST(Claim, TheEndOfARangeIsSeenButNotWhereAPartIsAbsent) {
  sim::DriveDescription model = HandMade::model();
  model.effects.push_back(
      {"compliance", {{"load_fraction", 0.3}, {"resonance", 70.0}, {"damping_ratio", 1.0}}, {}, {}});
  EXPECT_THAT(host::parameters_on_bound(model, {"compliance"}), testing::ElementsAre("compliance: damping_ratio"));
  model.effects.back().parameters["damping_ratio"] = 0.001;
  EXPECT_THAT(host::parameters_on_bound(model, {"compliance"}), testing::IsEmpty()) << "an undamped spring is a spring";
  model.effects.back().parameters["load_fraction"] = 0.02;
  EXPECT_THAT(host::parameters_on_bound(model, {"compliance"}), testing::ElementsAre("compliance: load_fraction"));
  model.effects.back() = {
      "backlash",
      {{"gap", 0.08}, {"load_fraction", 0.4}, {"resonance", 150.0}, {"damping_ratio", 0.05}, {"load_friction", 1.0}},
      {},
      {}};
  EXPECT_THAT(host::parameters_on_bound(model, {"backlash"}), testing::IsEmpty()) << "all friction is on the load";
  model.effects.back() = {"friction_lag", {{"time", 1e-4}}, {}, {}};
  EXPECT_THAT(host::parameters_on_bound(model, {"friction_lag"}), testing::IsEmpty());
}

TEST(Claim, AnotherFormOfAnEffectHasMoved) {
  const sim::EffectEntry level{"coulomb", {{"level", 2.0}}, {}, {}};
  const sim::EffectEntry sides{"coulomb", {{"positive", 2.0}, {"negative", -2.0}}, {}, {}};
  const sim::EffectEntry nearly{"coulomb", {{"level", 2.05}}, {}, {}};
  EXPECT_TRUE(host::has_moved(level, sides));
  EXPECT_TRUE(host::has_moved(sides, level));
  EXPECT_FALSE(host::has_moved(level, nearly));
}

std::vector<double> losses(std::size_t windows, double each) { return std::vector<double>(windows, each); }

TEST(Claim, LuckIsRuledOutByWindowsAndBroughtBackByCandidates) {
  // If all of five blocks improve, one combination of signs in 32 gives as large a gain; of twenty blocks, one in a
  // million.
  EXPECT_NEAR(host::probability_of_luck(losses(10, 4.0), losses(10, 1.0), 1, 2), 1.0 / 32.0, 0.006);
  EXPECT_NEAR(host::probability_of_luck(losses(10, 4.0), losses(10, 1.0), 20, 2), 20.0 / 32.0, 0.12);
  EXPECT_LT(host::probability_of_luck(losses(40, 4.0), losses(40, 1.0), 20, 2), 0.01);
  EXPECT_EQ(host::probability_of_luck(losses(40, 1.0), losses(40, 4.0), 20, 2), 1.0);
  EXPECT_EQ(host::probability_of_luck(losses(0, 1.0), losses(0, 4.0), 20, 2), 1.0);
}

TEST(Claim, TheSecondsToRecordSufficeWhereAllImproves) {
  for (const std::size_t tried : {1U, 25U, 50U}) {
    const auto windows = static_cast<std::size_t>(std::ceil(host::least_validation_s(tried) / host::kWindow_s));
    EXPECT_LE(host::probability_of_luck(losses(windows + 1, 4.0), losses(windows + 1, 1.0), tried, 1), host::kMostLuck)
        << tried;
  }
}

TEST(Probability, ACandidateThatTakesItAllHasIt) {
  host::Diagnosis found = diagnosis(20.0, 12.0);
  found.candidates = {candidate(12.0, 0.9, 0.9), candidate(12.0, 13.0, 19.0)};
  host::assign_probabilities(found);
  EXPECT_GT(found.candidates[0].probability, 0.9);
  EXPECT_LT(found.candidates[1].probability, 0.001);  // raises the error
  EXPECT_NEAR(sum_of_probabilities(found), 1.0, 1e-12);
}

TEST(Probability, EqualsShareItAndWhatIsLeftBelongsToSomethingElse) {
  host::Diagnosis tied = diagnosis(20.0, 12.0);
  tied.candidates = {candidate(12.0, 0.9, 0.9), candidate(12.0, 0.9, 0.9)};
  host::assign_probabilities(tied);
  EXPECT_DOUBLE_EQ(tied.candidates[0].probability, tied.candidates[1].probability);
  EXPECT_GT(tied.candidates[0].probability, 0.45);

  host::Diagnosis poor = diagnosis(20.0, 12.0);
  poor.candidates = {candidate(12.0, 9.0, 15.0)};
  host::assign_probabilities(poor);
  EXPECT_GT(poor.verdict.probability_other, 0.9);
  EXPECT_NEAR(sum_of_probabilities(poor), 1.0, 1e-12);
}

TEST(Probability, ASmallErrorIsProbablyNothing) {
  host::Diagnosis complete = diagnosis(0.85, 0.95);
  host::assign_probabilities(complete);
  EXPECT_GT(complete.verdict.probability_nothing, 0.7);  // with hardly any windows
  complete.candidates = {candidate(0.95, 0.90, 0.84)};
  host::assign_probabilities(complete);
  EXPECT_GT(complete.verdict.probability_nothing, 0.7);
  EXPECT_NEAR(sum_of_probabilities(complete), 1.0, 1e-12);
}

/// If the records do not suffice, or the residual is not noise, the verdict must not call the model complete.
TEST(Probability, AnObjectionToTheAllClearIsOneToNothing) {
  host::Diagnosis complete = diagnosis(0.85, 0.95);
  host::assign_probabilities(complete);
  const double clear = complete.verdict.probability_nothing;
  complete.verdict.status = host::Status::insufficient_data;
  host::assign_probabilities(complete);
  const double unshown = complete.verdict.probability_nothing;
  complete.verdict.status = host::Status::unexplained;
  host::assign_probabilities(complete);
  EXPECT_LT(unshown, clear);
  EXPECT_LT(complete.verdict.probability_nothing, unshown);
  EXPECT_NEAR(sum_of_probabilities(complete), 1.0, 1e-12);
}

}  // namespace
