// What the force balance's odds say about the effects for which the motion is searched.
#include "host/search/balance_odds.hpp"

#include <gmock/gmock.h>

#include "sim/catalogue.hpp"

namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

host::ScreenedModel tried(std::vector<std::string> kinds, double probability, double log_odds) {
  host::ScreenedModel model;
  model.model.effects = {{"inertia", {{"J", 0.01}}, {}, {}}, {"viscous", {{"B", 0.03}}, {}, {}}};
  for (const std::string& kind : kinds) {
    model.model.effects.push_back({kind, {}, {}, {}});
    if (kind == "compliance")
      model.model.effects.back().parameters = {{"resonance", 80.0},
                                               {"damping_ratio", 0.05},
                                               {"load_fraction", 0.4},
                                               {"load_friction", 0.0},
                                               {"load_viscous", 0.0}};
    if (kind == "cogging") model.model.effects.back().parameters = {{"cosine", 0.1}, {"sine", 0.0}, {"period", 5.0}};
    if (kind == "constant_torque") model.model.effects.back().parameters = {{"torque", 0.1}};
    if (kind == "dac_offset") model.model.effects.back().parameters = {{"offset", 0.1}};
  }
  model.kinds = std::move(kinds);
  model.probability = probability;
  model.log_odds = log_odds;
  return model;
}

/// Two kinds that cannot be told apart, and a spring far behind; then cogging beside the first of the two.
host::EffortScreen balance() {
  host::EffortScreen screen;
  screen.rows.steady = false;
  screen.steps = {
      {tried({"compliance"}, 1e-9, -3.0), tried({"dac_offset"}, 0.48, 16.0), tried({"constant_torque"}, 0.49, 16.0)},
      {tried({"constant_torque", "cogging"}, 0.6, 1.0), tried({"constant_torque", "compliance"}, 0.2, 0.5)}};
  return screen;
}

TEST(ForceBalanceOdds, TheProbableKindsHoldTheClaimTogether) {
  EXPECT_THAT(host::probable_kinds(balance(), {}), ElementsAre("constant_torque", "dac_offset"));
  EXPECT_THAT(host::probable_kinds(balance(), {"constant_torque"}), IsEmpty()) << "0.8 is no claim";
  EXPECT_THAT(host::probable_kinds(balance(), {"dac_offset"}), IsEmpty()) << "the balance did not choose it";
}

TEST(ForceBalanceOdds, TellApartWhatIsFarBehindTheLeader) {
  EXPECT_TRUE(host::are_told_apart(balance(), {}, "dac_offset", "compliance"));
  EXPECT_FALSE(host::are_told_apart(balance(), {}, "dac_offset", "constant_torque"));
  EXPECT_FALSE(host::are_told_apart(balance(), {}, "dac_offset", "tach_lag")) << "the balance cannot show it";
  EXPECT_FALSE(host::are_told_apart(balance(), {}, "compliance", "dac_offset"));
}

TEST(ForceBalanceOdds, ASecondMassIsPossibleWhereItIsMoreProbableThanNothing) {
  EXPECT_FALSE(host::allows_second_mass(balance(), {}));
  EXPECT_TRUE(host::allows_second_mass(balance(), {"constant_torque"}));
  EXPECT_FALSE(host::allows_second_mass(balance(), {"tach_lag"})) << "then the odds beside the base count";
  host::EffortScreen unlisted = balance();
  std::erase_if(unlisted.steps[1], [](const auto& one) { return one.kinds.back() == "compliance"; });
  EXPECT_FALSE(host::allows_second_mass(unlisted, {"constant_torque"}));
  unlisted.steps[0].front().log_odds = 3.0;
  EXPECT_TRUE(host::allows_second_mass(unlisted, {"constant_torque"})) << "an effect without odds has none against it";
  unlisted.steps[0].erase(unlisted.steps[0].begin());
  EXPECT_TRUE(host::allows_second_mass(unlisted, {}));
  EXPECT_TRUE(host::allows_second_mass({}, {}));
}

TEST(ForceBalanceOdds, AStartIsFoundInAnyOrderOfTheEffects) {
  const sim::EffectInfo& offset = *sim::find_effect("constant_torque");
  const auto start = host::balanced_start(balance(), {"cogging"}, offset);
  ASSERT_TRUE(start);
  EXPECT_EQ(start->effects.back().kind, "constant_torque");
}

TEST(ForceBalanceOdds, AnOrderOfATurnStartsAsAWaveWithItsOwnPeriod) {
  host::EffortScreen screen = balance();
  host::ScreenedModel wave = tried({"cogging"}, 0.99, 40.0);
  wave.model.effects.back().parameters = {{"cosine_4", 0.1}, {"sine_4", 0.2}, {"period", 10.0}};
  screen.steps.front().push_back(wave);
  const auto start = host::balanced_start(screen, {}, *sim::find_effect("cogging"));
  ASSERT_TRUE(start);
  const sim::EffectEntry& entry = start->effects.back();
  EXPECT_THAT(entry.parameters,
              ElementsAre(std::pair("cosine", 0.1), std::pair("period", 2.5), std::pair("sine", 0.2)));
}

}  // namespace
