#include "host/fit/parameter_vector.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/host/evidence/hand_made_record.hpp"

namespace {

sim::DriveDescription with_stribeck(double omega2_positive) {
  sim::DriveDescription model = HandMade::model();
  model.effects.push_back({"stribeck",
                           {{"static_positive", 3.0},
                            {"static_negative", -2.5},
                            {"omega1_positive", 4.9},
                            {"omega1_negative", -4.7},
                            {"omega2_positive", omega2_positive},
                            {"omega2_negative", -4.7}},
                           {},
                           {}});
  return model;
}

Eigen::Index place_of(const host::ParameterVector& vector, const sim::DriveDescription& model,
                      const std::string& name) {
  const auto& all = vector.parameters();
  const auto found = std::ranges::find_if(all, [&](const auto& free) { return free.name(model) == name; });
  return found == all.end() ? -1 : found - all.begin();
}

TEST(ParameterVector, ReadsWhatItWrote) {
  const sim::DriveDescription model = with_stribeck(6.0);
  const host::ParameterVector vector(model);
  // J, B, two Coulomb levels, two static levels, omega1 and omega2 forward, one omega backward.
  ASSERT_EQ(vector.size(), 9u);
  Eigen::VectorXd values = vector.read(model);
  for (Eigen::Index k = 0; k < values.size(); ++k) values(k) *= 1.0 + 0.01 * static_cast<double>(k + 1);
  sim::DriveDescription written = model;
  vector.write(values, written);
  EXPECT_EQ(vector.read(written), values);
  EXPECT_EQ(written.find("inertia")->at("J"), 1.01 * HandMade::kInertia);
}

TEST(ParameterVector, WritingWhatWasReadChangesNothing) {
  const sim::DriveDescription model = with_stribeck(6.0);
  sim::DriveDescription written = model;
  const host::ParameterVector vector(model);
  vector.write(vector.read(model), written);
  for (std::size_t k = 0; k < model.effects.size(); ++k)
    EXPECT_EQ(written.effects[k].parameters, model.effects[k].parameters) << model.effects[k].kind;
}

TEST(ParameterVector, EqualSpeedsOfOneDirectionStayEqual) {
  const sim::DriveDescription model = with_stribeck(4.9);
  const host::ParameterVector vector(model);
  ASSERT_EQ(vector.size(), 8u);
  EXPECT_EQ(place_of(vector, model, "stribeck.omega2_positive"), -1);
  const Eigen::Index omega = place_of(vector, model, "stribeck.omega1_positive");
  ASSERT_GE(omega, 0);
  Eigen::VectorXd values = vector.read(model);
  values(omega) = 7.25;
  sim::DriveDescription written = model;
  vector.write(values, written);
  const sim::EffectEntry& stribeck = *written.find("stribeck");
  EXPECT_EQ(stribeck.at("omega1_positive"), 7.25);
  EXPECT_EQ(stribeck.at("omega2_positive"), 7.25);
  EXPECT_EQ(stribeck.at("omega1_negative"), -4.7);
  EXPECT_EQ(stribeck.at("omega2_negative"), -4.7);
}

TEST(ParameterVector, ACurveOverPhaseStaysClosed) {
  sim::DriveDescription model = HandMade::model();
  sim::EffectEntry curve{
      "free_curve",
      {{"knot_0", 0.0}, {"value_0", 0.1}, {"knot_1", 1.0}, {"value_1", 0.2}, {"knot_2", 2.0}, {"value_2", 0.1}},
      {},
      {}};
  curve.over = "phase";
  model.effects.push_back(curve);
  const host::ParameterVector vector(model);
  const Eigen::Index first = place_of(vector, model, "free_curve.value_0");
  ASSERT_GE(first, 0);
  EXPECT_EQ(place_of(vector, model, "free_curve.value_2"), -1);
  Eigen::VectorXd values = vector.read(model);
  values(first) = 0.3;
  vector.write(values, model);
  EXPECT_EQ(model.find("free_curve")->at("value_0"), 0.3);
  EXPECT_EQ(model.find("free_curve")->at("value_2"), 0.3);
}

TEST(ParameterVector, DifferentSpeedsOfOneDirectionMoveAlone) {
  const sim::DriveDescription model = with_stribeck(6.0);
  const host::ParameterVector vector(model);
  Eigen::VectorXd values = vector.read(model);
  values(place_of(vector, model, "stribeck.omega1_positive")) = 7.25;
  sim::DriveDescription written = model;
  vector.write(values, written);
  EXPECT_EQ(written.find("stribeck")->at("omega1_positive"), 7.25);
  EXPECT_EQ(written.find("stribeck")->at("omega2_positive"), 6.0);
}

TEST(ParameterVector, WritesNothingBeyondTheBounds) {
  const sim::DriveDescription model = HandMade::model();
  const host::ParameterVector vector(model);
  Eigen::VectorXd values = vector.read(model);
  const Eigen::Index inertia = place_of(vector, model, "inertia.J");
  ASSERT_GE(inertia, 0);
  values(inertia) = -1.0;
  sim::DriveDescription written = model;
  vector.write(values, written);
  EXPECT_EQ(written.find("inertia")->at("J"), vector.parameters()[static_cast<std::size_t>(inertia)].lower);
  EXPECT_GE(written.find("inertia")->at("J"), 0.0);
}

}  // namespace
