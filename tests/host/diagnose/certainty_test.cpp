// The verdict follows from the probabilities of its effects.
#include "host/diagnose/certainty.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace host {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

JudgedCandidate candidate(const std::vector<std::string>& kinds, double probability, double after = 2.0) {
  JudgedCandidate judged;
  judged.kinds = kinds;
  judged.before = 20.0;
  judged.after = judged.train_after = after;
  judged.probability = probability;
  return judged;
}

Diagnosis claimed(const std::vector<std::string>& effects, std::vector<JudgedCandidate> candidates,
                  Status status = Status::missing) {
  Diagnosis diagnosis;
  diagnosis.candidates = std::move(candidates);
  diagnosis.verdict.status = status;
  diagnosis.verdict.effects = effects;
  settle_status(diagnosis);
  return diagnosis;
}

TEST(Certainty, AnEffectHoldsWhatEveryCandidateWithItHolds) {
  const Diagnosis diagnosis =
      claimed({"cogging"}, {candidate({"cogging"}, 0.6), candidate({"cogging", "backlash"}, 0.37)});
  EXPECT_DOUBLE_EQ(probability_of(diagnosis, {"cogging"}), 0.97);
  EXPECT_DOUBLE_EQ(probability_of(diagnosis, {"backlash", "cogging"}), 0.37);
  EXPECT_EQ(diagnosis.verdict.status, Status::missing);
  EXPECT_THAT(diagnosis.verdict.effects, ElementsAre("cogging"));
}

/// An earlier version said "missing: torque_ripple" with 6 %, although "something else" had 67 %.
TEST(Certainty, WhatIsImprobableIsNotNamed) {
  const Diagnosis diagnosis =
      claimed({"torque_ripple"}, {candidate({"torque_ripple"}, 0.06), candidate({"cogging"}, 0.2)});
  EXPECT_EQ(diagnosis.verdict.status, Status::unexplained);
  EXPECT_THAT(diagnosis.verdict.effects, IsEmpty());
}

TEST(Certainty, RivalsThatTogetherHoldItAreAGroup) {
  const Diagnosis diagnosis =
      claimed({"constant_torque"}, {candidate({"constant_torque"}, 0.55), candidate({"dac_offset"}, 0.41)});
  EXPECT_EQ(diagnosis.verdict.status, Status::ambiguous);
  EXPECT_THAT(diagnosis.verdict.effects, ElementsAre("constant_torque", "dac_offset"));
  EXPECT_THAT(modelled_kinds(diagnosis), ElementsAre("constant_torque"));
}

TEST(Certainty, WhatIsDeniedByItselfIsNoRival) {
  const Diagnosis diagnosis = claimed(
      {"constant_torque"},
      {candidate({"constant_torque"}, 0.5), candidate({"dac_offset"}, 0.42), candidate({"spring_torque"}, 0.04)});
  EXPECT_THAT(diagnosis.verdict.effects, ElementsAre("constant_torque", "dac_offset"));
  const Diagnosis of_two = claimed({"compliance"}, {candidate({"compliance"}, 0.92), candidate({"backlash"}, 0.04)});
  EXPECT_EQ(of_two.verdict.status, Status::ambiguous) << "one name alone needs 95 %";
}

/// Most records cannot tell an offset of the command from a weight, but they can tell an encoder error from both.
TEST(Certainty, WhatIsCertainStandsBesideAGroup) {
  const Diagnosis diagnosis =
      claimed({"dac_offset", "encoder_cyclic_error"}, {candidate({"dac_offset", "encoder_cyclic_error"}, 0.49),
                                                       candidate({"constant_torque", "encoder_cyclic_error"}, 0.48)});
  EXPECT_EQ(diagnosis.verdict.status, Status::missing);
  EXPECT_THAT(diagnosis.verdict.effects, ElementsAre("encoder_cyclic_error"));
}

TEST(Certainty, AFurtherEffectIsNamedWhereItIsCertainAndTakesEnough) {
  const auto named = [](double probability, double after) {
    std::vector<JudgedCandidate> candidates{candidate({"cogging"}, 1.0 - probability, 4.0),
                                            candidate({"cogging", "backlash"}, probability, after)};
    for (JudgedCandidate& one : candidates) one.level = {one.after, one.after};
    return claimed({"cogging"}, candidates).verdict.effects;
  };
  EXPECT_THAT(named(0.97, 3.0), ElementsAre("cogging", "backlash"));
  EXPECT_THAT(named(0.9, 3.0), ElementsAre("cogging"));
  EXPECT_THAT(named(0.97, 3.95), ElementsAre("cogging")) << "certain is not important";
}

TEST(Certainty, APairIsNamedWhereItHoldsTheClaim) {
  const std::vector<JudgedCandidate> surely{candidate({"cogging"}, 0.02), candidate({"cogging", "backlash"}, 0.96)};
  EXPECT_THAT(claimed({"cogging", "backlash"}, surely).verdict.effects, ElementsAre("cogging", "backlash"));
  const std::vector<JudgedCandidate> perhaps{candidate({"cogging"}, 0.3), candidate({"cogging", "backlash"}, 0.67)};
  EXPECT_THAT(claimed({"cogging", "backlash"}, perhaps).verdict.effects, ElementsAre("cogging"));
}

TEST(Certainty, RivalsForThePlaceOfTheSecondAreAGroupBesideTheFirst) {
  const Diagnosis diagnosis = claimed(
      {"cogging", "backlash"}, {candidate({"cogging", "backlash"}, 0.6), candidate({"cogging", "compliance"}, 0.37)});
  EXPECT_EQ(diagnosis.verdict.status, Status::missing);
  EXPECT_THAT(diagnosis.verdict.effects, ElementsAre("cogging"));
  EXPECT_THAT(diagnosis.verdict.alternatives, ElementsAre(ElementsAre("backlash", "compliance")));
}

TEST(Certainty, WhatIsNotCertainBesideTheFirstIsNotNamed) {
  const Diagnosis diagnosis =
      claimed({"encoder_cyclic_error", "presliding"},
              {candidate({"encoder_cyclic_error"}, 0.2), candidate({"encoder_cyclic_error", "presliding"}, 0.16),
               candidate({"encoder_cyclic_error", "stribeck"}, 0.6)});
  EXPECT_EQ(diagnosis.verdict.status, Status::missing);
  EXPECT_THAT(diagnosis.verdict.effects, ElementsAre("encoder_cyclic_error"));
  EXPECT_THAT(diagnosis.verdict.alternatives, IsEmpty());

  Diagnosis of_many = diagnosis;
  of_many.verdict.effects = {"encoder_cyclic_error", "presliding"};
  of_many.verdict.alternatives = {{"presliding", "stribeck"}, {"presliding", "a", "b", "c", "d", "e", "f"}};
  settle_status(of_many);
  EXPECT_THAT(of_many.verdict.alternatives, ElementsAre(ElementsAre("presliding", "stribeck"))) << "many are no answer";
}

TEST(Certainty, WhatTakesLessThanATenthIsNotNamedHoweverCertain) {
  EXPECT_EQ(claimed({"cogging"}, {candidate({"cogging"}, 0.99, 19.5)}).verdict.status, Status::unexplained);
}

TEST(Certainty, AGroupThatDoesNotHoldItIsNone) {
  const std::vector<JudgedCandidate> two{candidate({"constant_torque"}, 0.2), candidate({"dac_offset"}, 0.2)};
  EXPECT_EQ(claimed({"constant_torque", "dac_offset"}, two, Status::ambiguous).verdict.status, Status::unexplained);
}

}  // namespace
}  // namespace host
