// A verdict follows from its probabilities.
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

/// Was "missing: torque_ripple" with 6 % beside "something else" with 67 %.
TEST(Certainty, WhatIsImprobableIsNotNamed) {
  const Diagnosis diagnosis =
      claimed({"torque_ripple"}, {candidate({"torque_ripple"}, 0.06), candidate({"cogging"}, 0.2)});
  EXPECT_EQ(diagnosis.verdict.status, Status::unexplained);
  EXPECT_THAT(diagnosis.verdict.effects, IsEmpty());
}

TEST(Certainty, RivalsThatTogetherHoldItAreAGroup) {
  const Diagnosis diagnosis =
      claimed({"constant_torque"}, {candidate({"constant_torque"}, 0.45), candidate({"dac_offset"}, 0.4)});
  EXPECT_EQ(diagnosis.verdict.status, Status::ambiguous);
  EXPECT_THAT(diagnosis.verdict.effects, ElementsAre("constant_torque", "dac_offset"));
  EXPECT_THAT(modelled_kinds(diagnosis), ElementsAre("constant_torque"));
}

/// Most records cannot tell an offset of the command from a weight, but they can tell the encoder's error from both.
TEST(Certainty, WhatIsCertainStandsBesideAGroup) {
  const Diagnosis diagnosis =
      claimed({"dac_offset", "encoder_cyclic_error"}, {candidate({"dac_offset", "encoder_cyclic_error"}, 0.49),
                                                       candidate({"constant_torque", "encoder_cyclic_error"}, 0.48)});
  EXPECT_EQ(diagnosis.verdict.status, Status::missing);
  EXPECT_THAT(diagnosis.verdict.effects, ElementsAre("encoder_cyclic_error"));
}

TEST(Certainty, APairStaysNamedWhileItsFirstIsMoreProbableThanNot) {
  const Diagnosis diagnosis =
      claimed({"cogging", "backlash"}, {candidate({"cogging"}, 0.3), candidate({"cogging", "backlash"}, 0.67)});
  EXPECT_EQ(diagnosis.verdict.status, Status::missing);
  EXPECT_THAT(diagnosis.verdict.effects, ElementsAre("cogging", "backlash"));
}

/// Was "missing: encoder_cyclic_error + presliding" with 16 % for the second.
TEST(Certainty, TheSecondOfAPairIsNamedOnlyWhereItIsMoreProbableThanNot) {
  const Diagnosis diagnosis =
      claimed({"encoder_cyclic_error", "presliding"},
              {candidate({"encoder_cyclic_error"}, 0.05), candidate({"encoder_cyclic_error", "presliding"}, 0.16),
               candidate({"encoder_cyclic_error", "stribeck"}, 0.6)});
  EXPECT_EQ(diagnosis.verdict.status, Status::missing);
  EXPECT_THAT(diagnosis.verdict.effects, ElementsAre("encoder_cyclic_error"));

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
