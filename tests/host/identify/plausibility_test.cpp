// Values that no drive can have are reported, no matter which method fitted them.
#include "host/identify/plausibility.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/model/model_file.hpp"

namespace {

using testing::HasSubstr;

sim::DriveDescription with(const char* effect, const char* id, double value, std::array<double, 2> interval) {
  sim::DriveDescription model = *host::paper_drive("x");
  if (model.find(effect) == nullptr) model.effects.push_back({effect, {}, {}, "fit.csv"});
  model.find(effect)->parameters[id] = value;
  model.find(effect)->ci95[id] = interval;
  return model;
}

/// All doubts as one text. Those that forbid a design end with '!'.
std::string doubts(const sim::DriveDescription& model) {
  std::string text;
  for (const host::Doubt& doubt : host::doubts_of(model)) text += doubt.message + (doubt.refuses ? "!\n" : "\n");
  return text;
}

TEST(Plausibility, ThePapersDrivesAreDrives) {
  EXPECT_EQ(doubts(*host::paper_drive("x")), "");
  EXPECT_EQ(doubts(*host::paper_drive("y")), "");
}

TEST(Plausibility, FrictionThatPushesIsNamed) {
  EXPECT_THAT(doubts(with("coulomb", "positive", -0.5, {-0.6, -0.4})), HasSubstr("friction cannot drive the axis"));
  EXPECT_THAT(doubts(with("coulomb", "negative", 0.5, {0.4, 0.6})), HasSubstr("friction cannot drive the axis"));
  EXPECT_THAT(doubts(with("viscous", "B", -0.01, {-0.02, -0.005})), HasSubstr("friction cannot drive the axis"));
  EXPECT_THAT(doubts(with("inertia", "J", -0.01, {-0.02, -0.005})), HasSubstr("no mass is negative"));
}

TEST(Plausibility, AValueThatMayBeZeroIsSaidButServes) {
  const std::string text = doubts(with("viscous", "B", 0.001, {-0.004, 0.006}));
  EXPECT_THAT(text, HasSubstr("may be zero"));
  EXPECT_THAT(text, testing::Not(HasSubstr("!")));
}

TEST(Plausibility, AnUndeterminedInertiaIsRefused) {
  EXPECT_THAT(doubts(with("inertia", "J", 0.01, {-0.02, 0.04})), HasSubstr("do not determine it!"));
}

TEST(Plausibility, AFitOnItsBoundIsNoFinding) {
  EXPECT_THAT(doubts(with("load_dependent_friction", "coefficient", 0.9, {0.85, 0.95})), HasSubstr("on a bound"));
  sim::DriveDescription typed = with("load_dependent_friction", "coefficient", 0.9, {0.85, 0.95});
  typed.find("load_dependent_friction")->ci95.clear();
  typed.find("load_dependent_friction")->from.clear();
  EXPECT_EQ(doubts(typed), "") << "a value that was not fitted is not doubted";
}

TEST(Plausibility, AnAmplitudeWithinItsIntervalIsNone) {
  sim::DriveDescription model = with("cogging", "cosine", 0.1, {-0.3, 0.5});
  model.find("cogging")->parameters["sine"] = 0.1;
  model.find("cogging")->ci95["sine"] = {-0.3, 0.5};
  model.find("cogging")->parameters["period"] = 2.5;
  EXPECT_THAT(doubts(model), HasSubstr("may be zero"));
}

TEST(Plausibility, FrictionBeyondTheMotorIsNamed) {
  EXPECT_THAT(doubts(with("coulomb", "positive", 100.0, {99.0, 101.0})), HasSubstr("more than the motor gives"));
}

TEST(Plausibility, WhoKnowsBetterMayAcceptAnEffect) {
  const sim::DriveDescription model = with("coulomb", "positive", -0.5, {-0.6, -0.4});
  EXPECT_NO_THROW(host::require_plausible(model, {"coulomb"}));
  try {
    host::require_plausible(model, {"viscous"});
    FAIL() << "designed for friction that pushes";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::refused);
    EXPECT_THAT(failure.what(), HasSubstr("--accept coulomb"));
  }
}

// With the friction from a weak log, a model was written that no command could read.
TEST(Plausibility, WhatNoReaderTakesIsMovedOntoItsBound) {
  sim::DriveDescription model = with("viscous", "B", -0.01, {-0.02, 0.005});
  EXPECT_THROW((void)host::parse_model(host::format_model(model), "weak.toml"), host::Failure);
  std::vector<std::string> warnings;
  for (sim::EffectEntry& entry : model.effects) host::keep_within_bounds(entry, model.data.kind, warnings);
  EXPECT_EQ(host::parse_model(host::format_model(model), "weak.toml").find("viscous")->at("B"), 0.0);
  EXPECT_THAT(warnings, testing::ElementsAre(HasSubstr("B_Nm_s_per_rad = 0")));
}

}  // namespace
