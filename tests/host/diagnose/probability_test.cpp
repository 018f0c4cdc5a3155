// Stated probabilities as a function of the candidates' remaining error and of the p-value of their gain.
#include "host/diagnose/probability.hpp"

#include <gtest/gtest.h>

#include "tests/host/diagnose/sum_of_probabilities.hpp"

namespace {

host::JudgedCandidate candidate(const char* kind, double after, double luck) {
  host::JudgedCandidate judged;
  judged.kinds = {kind};
  judged.before = 20.0;
  judged.after = judged.train_after = after;
  judged.level = {after, after};
  judged.luck = luck;
  return judged;
}

host::Diagnosis diagnosis_of(std::vector<host::JudgedCandidate> candidates, double before = 20.0) {
  host::Diagnosis diagnosis;
  diagnosis.before_train = diagnosis.before_validate = before;
  diagnosis.base_level = {before, before};
  diagnosis.candidates = std::move(candidates);
  host::assign_probabilities(diagnosis);
  return diagnosis;
}

TEST(Probabilities, SumToOneWhateverThereIs) {
  EXPECT_NEAR(sum_of_probabilities(diagnosis_of({})), 1.0, 1e-12);
  EXPECT_NEAR(sum_of_probabilities(diagnosis_of({candidate("cogging", 1.0, 0.0), candidate("backlash", 9.0, 0.2)})),
              1.0, 1e-12);
  EXPECT_NEAR(sum_of_probabilities(diagnosis_of({candidate("cogging", 19.0, 1.0)})), 1.0, 1e-12);
  EXPECT_NEAR(sum_of_probabilities(diagnosis_of({}, 1.0)), 1.0, 1e-12);
}

TEST(Probabilities, WhatMayBeLuckTakesNothingFromTheOthers) {
  const double alone = diagnosis_of({candidate("cogging", 1.0, 0.0)}).candidates[0].probability;
  const host::Diagnosis beside = diagnosis_of({candidate("cogging", 1.0, 0.0), candidate("backlash", 1.0, 1.0)});
  EXPECT_GT(alone, 0.9);
  EXPECT_NEAR(beside.candidates[0].probability, alone, 1e-12);
  EXPECT_EQ(beside.candidates[1].probability, 0.0);
}

TEST(Probabilities, EqualsShareAndLuckIsTakenOff) {
  const host::Diagnosis equal = diagnosis_of({candidate("cogging", 1.0, 0.0), candidate("backlash", 1.0, 0.0)});
  EXPECT_NEAR(equal.candidates[0].probability, equal.candidates[1].probability, 1e-12);
  const double sure = diagnosis_of({candidate("cogging", 1.0, 0.0)}).candidates[0].probability;
  EXPECT_NEAR(diagnosis_of({candidate("cogging", 1.0, 0.4)}).candidates[0].probability, 0.6 * sure, 1e-12);
}

TEST(Probabilities, WhatLeavesMuchIsLessProbableThanSomethingElse) {
  const host::Diagnosis poor = diagnosis_of({candidate("cogging", 15.0, 0.0)});
  EXPECT_GT(poor.verdict.probability_other, poor.candidates[0].probability);
  EXPECT_LT(poor.verdict.probability_nothing, 0.01);
  EXPECT_GT(diagnosis_of({}, 1.0).verdict.probability_nothing, 0.5);  // on a single window
}

}  // namespace
