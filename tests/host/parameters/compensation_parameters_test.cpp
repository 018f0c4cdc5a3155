// Conversion of a model's effects to the board's compensation.
#include "host/parameters/compensation_parameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/app/parameters/axis_values.hpp"
#include "host/identify/paper_drives.hpp"
#include "host/parameters/board_parameters.hpp"
#include "host/parameters/parameter_file.hpp"
#include "host/parameters/parameter_names.hpp"

namespace {

using testing::ElementsAre;

sim::DriveDescription paper_x_with(std::vector<sim::EffectEntry> effects) {
  sim::DriveDescription model = *host::paper_drive("x");
  for (sim::EffectEntry& entry : effects) model.effects.push_back(std::move(entry));
  return model;
}

double value_of(const sim::DriveDescription& model, std::string_view name) {
  const auto list = host::compensation_parameters(model);
  const auto at = std::ranges::find(list, name, &host::CompensationParameter::name);
  return at == list.end() ? std::nan("") : at->value;
}

sim::EffectEntry cogging(double cosine, double sine, double period_mm) {
  return {"cogging", {{"cosine", cosine}, {"sine", sine}, {"period", period_mm}}, {}, {}};
}

TEST(CompensationParameters, AreAllOffForAModelWithoutSuchEffects) {
  const auto list = host::compensation_parameters(paper_x_with({}));
  for (const char* part : {"cogging", "presliding", "position_friction", "backlash"})
    EXPECT_EQ(value_of(paper_x_with({}), std::string(part) + ".on"), 0.0) << "an earlier compensation is switched off";
  EXPECT_EQ(value_of(paper_x_with({}), "calibration.tachometer_gain"), 1.0);
  EXPECT_EQ(list.size(), 6u);
}

TEST(CompensationParameters, OfCoggingsTheLargestAreTaken) {
  const auto model =
      paper_x_with({cogging(0.1, 0, 10), cogging(0, 0.4, 5), cogging(0.3, 0.3, 2.5), cogging(0.2, 0, 1)});
  EXPECT_EQ(value_of(model, "cogging.period_1"), 2.5);
  EXPECT_EQ(value_of(model, "cogging.period_2"), 5.0);
  EXPECT_EQ(value_of(model, "cogging.period_3"), 1.0);
  EXPECT_EQ(value_of(model, "cogging.sine_2"), 0.4);
}

// Catches orders that are treated as separate periods, or left out: compensation would then add a ripple.
TEST(CompensationParameters, OrdersOfOnePeriodAreRipplesOfTheirOwn) {
  sim::EffectEntry motor = cogging(0.1, 0.0, 12.0);
  motor.parameters.insert({{"cosine_6", 0.0}, {"sine_6", 0.3}, {"cosine_24", 0.2}, {"sine_24", 0.0}});
  const auto model = paper_x_with({motor});
  EXPECT_EQ(value_of(model, "cogging.period_1"), 2.0);
  EXPECT_EQ(value_of(model, "cogging.sine_1"), 0.3);
  EXPECT_EQ(value_of(model, "cogging.period_2"), 0.5);
  EXPECT_EQ(value_of(model, "cogging.period_3"), 12.0);
}

TEST(CompensationParameters, BacklashBringsTheTwistUnderFriction) {
  const auto model = paper_x_with(
      {{"backlash", {{"gap", 0.04}, {"resonance", 90.0}, {"damping_ratio", 0.1}, {"load_fraction", 0.3}}, {}, {}}});
  EXPECT_EQ(value_of(model, "backlash.gap"), 0.04);
  // J1 = 0.7 J, J2 = 0.3 J and k = w^2 J1 J2 / (J1 + J2); twist Tc / k with the mean of 2.205 and 1.656 Nm.
  const double rate = 2.0 * std::numbers::pi * 90.0;
  const double stiffness_Nm_per_rad = 7.65e-3 * 0.7 * 0.3 * rate * rate;
  EXPECT_NEAR(value_of(model, "backlash.wind_up"),
              (2.205 + 1.656) / 2.0 / stiffness_Nm_per_rad * 10.0 / (2.0 * std::numbers::pi), 1e-9);
}

TEST(CompensationParameters, DesignAndCompensationAreOneFileThatABoardTakes) {
  const auto model =
      paper_x_with({cogging(0.3, -0.2, 2.5),
                    {"presliding", {{"sigma0", 60.0}, {"sigma1", 1.0}}, {}, {}},
                    {"position_dependent_friction", {{"cosine", 0.2}, {"sine", 0.1}, {"period", 70}}, {}, {}},
                    {"tach_gain", {{"gain", 1.02}}, {}, {}},
                    {"tach_offset", {{"offset", 0.3}}, {}, {}}});
  const std::string text = board_parameters_toml(model, host::design_axis(model, {})) + host::compensation_toml(model);
  firmware::ParameterValues values;
  for (const host::Assignment& assignment : host::parse_parameter_text(text, "params.toml"))
    values.set(assignment.place, assignment.value);
  EXPECT_NO_THROW(host::require_fitting_set(values)) << text;
  const auto at = [&](const char* name) { return values.at(host::require_place(name)); };
  EXPECT_EQ(at("x.cogging.sine_1"), -0.2F);
  EXPECT_EQ(at("x.presliding.stiffness"), 60.0F);
  EXPECT_EQ(at("x.position_friction.period"), 70.0F);
  EXPECT_EQ(at("x.calibration.tachometer_gain"), 1.02F);
  EXPECT_EQ(at("x.calibration.tachometer_offset"), 0.3F);
  EXPECT_EQ(at("x.backlash.on"), 0.0F);
  EXPECT_EQ(host::core_compensation(model).cogging_V[0].sine,
            firmware::axis_parameters<float>(values.axis(0)).compensation.cogging_V[0].sine);
}

TEST(CompensationParameters, WhatABoardCannotTakeUpIsNamed) {
  const auto model = paper_x_with({cogging(0.1, 0, 10), {"compliance", {}, {}, {}}, {"compliance", {}, {}, {}}});
  EXPECT_THAT(host::uncompensated_effects(model), ElementsAre("compliance"));
  const auto many =
      paper_x_with({cogging(0.1, 0, 10), cogging(0.2, 0, 5), cogging(0.05, 0, 2.5), cogging(0.01, 0, 1.25)});
  EXPECT_THAT(host::uncompensated_effects(many), ElementsAre("cogging beyond its 3 largest harmonics"));
}

}  // namespace
