// The catalogue as text pages and as JSON.
#include "host/report/effect_pages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "host/model/model_file.hpp"
#include "sim/catalogue.hpp"
#include "sim/drive.hpp"

namespace {

using testing::HasSubstr;

constexpr host::Terminal kPlain{.is_terminal = false, .colour = false, .columns = 90};

constexpr const char* kRotary = R"(format = "axis-model/1"
[drive]
kind = "rotary"
amplifier_gain_A_per_V = 6.4898
torque_constant_Nm_per_A = 0.4769
lead_mm_per_rad = 1.5915494309189535
sample_period_s = 0.001
)";
constexpr const char* kLinear = R"(format = "axis-model/1"
[drive]
kind = "linear"
force_constant_N_per_V = 35.0
sample_period_s = 0.001
)";

std::string joined_lines(std::string text) {
  std::string joined;
  std::istringstream words(text);
  for (std::string word; words >> word;) joined += (joined.empty() ? "" : " ") + word;
  return joined;
}

TEST(EffectList, NamesEveryKindOnceWithItsTitle) {
  const std::string list = host::effect_list(kPlain);
  for (const sim::EffectInfo* info : sim::catalogue()) {
    const std::string line = "\n  " + std::string(info->kind) + " ";
    const std::size_t at = list.find(line);
    ASSERT_NE(at, std::string::npos) << info->kind;
    EXPECT_EQ(list.find(line, at + 1), std::string::npos) << info->kind;
    EXPECT_THAT(list.substr(at + 1, list.find('\n', at + 1) - at), HasSubstr(info->title));
  }
}

TEST(EffectList, FollowsTheSignalPath) {
  const std::string list = host::effect_list(kPlain);
  std::size_t last = 0;
  for (const char* kind : {"  dac_offset ", "  torque_ripple ", "  cogging ", "  stribeck ", "  compliance ",
                           "  encoder_cyclic_error ", "  tach_gain "}) {
    const std::size_t at = list.find(kind);
    ASSERT_NE(at, std::string::npos) << kind;
    EXPECT_GT(at, last) << kind;
    last = at;
  }
}

TEST(EffectList, StaysWithinTheTerminal) {
  std::istringstream lines(host::effect_list(kPlain));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 90u) << line;
}

TEST(EffectPage, HoldsEverythingTheCatalogueKnows) {
  for (const sim::EffectInfo* info : sim::catalogue()) {
    const std::string page = joined_lines(host::effect_page(*info, kPlain));
    for (const std::string_view text :
         {info->kind, info->title, info->equation, info->shows, info->separate_by, info->origin, info->remedy})
      EXPECT_THAT(page, HasSubstr(text));
    for (const sim::ParameterInfo& parameter : info->parameters) {
      EXPECT_THAT(page, HasSubstr(parameter.rotary_key));
      EXPECT_THAT(page, HasSubstr(parameter.linear_key));
      EXPECT_THAT(page, HasSubstr(parameter.doc));
    }
    for (const std::string_view other : info->confused_with) EXPECT_THAT(page, HasSubstr(other));
  }
}

TEST(EffectPage, SeparatesSectionsByOneEmptyLine) {
  for (const sim::EffectInfo* info : sim::catalogue())
    EXPECT_THAT(host::effect_page(*info, kPlain), testing::Not(HasSubstr("\n\n\n")));
  EXPECT_THAT(host::effect_list(kPlain), testing::Not(HasSubstr("\n\n\n")));
}

TEST(EffectExample, ReadsAsAPartOfAModelOfEitherKind) {
  for (const sim::DriveKind kind : {sim::DriveKind::rotary, sim::DriveKind::linear}) {
    std::string base = kind == sim::DriveKind::rotary ? kRotary : kLinear;
    for (const char* part : {"inertia", "viscous", "coulomb"})
      base += host::effect_example_toml(*sim::find_effect(part), kind);
    for (const sim::EffectInfo* info : sim::catalogue()) {
      const std::string text = info->base ? base : base + host::effect_example_toml(*info, kind);
      sim::DriveDescription model;
      ASSERT_NO_THROW(model = host::parse_model(text, "example.toml")) << text;
      ASSERT_NE(model.find(info->kind), nullptr);
      EXPECT_NO_THROW(sim::Drive{model}) << info->kind;
    }
  }
}

TEST(EffectsJson, HoldsTheCatalogue) {
  const nlohmann::json all = host::effects_json();
  EXPECT_EQ(all["format"], "axis-effects/1");
  ASSERT_EQ(all["effects"].size(), sim::catalogue().size());
  for (std::size_t k = 0; k < sim::catalogue().size(); ++k) {
    const sim::EffectInfo& info = *sim::catalogue()[k];
    const nlohmann::json& effect = all["effects"][k];
    EXPECT_EQ(effect["kind"], info.kind);
    EXPECT_EQ(effect["parameters"].size(), info.parameters.size());
    EXPECT_EQ(effect["confused_with"].size(), info.confused_with.size());
    EXPECT_EQ(host::effects_json(info)["effects"][0], effect);
  }
  const nlohmann::json coulomb = host::effects_json(*sim::find_effect("coulomb"))["effects"][0];
  EXPECT_EQ(coulomb["parameters"][2]["rotary_key"], "level_Nm");
  EXPECT_EQ(coulomb["parameters"][2]["linear_key"], "level_N");
  EXPECT_EQ(coulomb["parameters"][2]["stands_for"], (nlohmann::json{"positive", "negative"}));
}

}  // namespace
