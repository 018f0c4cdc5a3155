// Fits of a model to records: their budget, and what they leave and move.
#include "host/fit/model_fit.hpp"

#include <gtest/gtest.h>

#include "host/fit/base_fit.hpp"
#include "host/fit/data_sheet_conflict.hpp"
#include "tests/host/evidence/hand_made_record.hpp"

namespace {

sim::DriveDescription heavier(sim::DriveDescription model) {
  model.find("inertia")->parameters["J"] *= 1.3;
  return model;
}

TEST(FitBudget, EndsAFitThatHasUsedItUpAndNoOther) {
  const host::Record record = HandMade::record(3.0);
  const sim::DriveDescription model = heavier(HandMade::model());
  const host::RecordSet set = host::compare_on({&record}, model);
  const double pass = host::steps_of(sim::Drive(model), set);
  const host::FitResult free = host::fit_model(model, set);
  ASSERT_FALSE(free.cut_short);
  ASSERT_GT(free.iterations, 2) << "something to cut";

  // At the check of the budget, one evaluation of the errors and one of the Jacobian are in progress.
  const double slopes = static_cast<double>(host::ParameterVector(model, host::Freedom::everything).size()) + 1.0;
  const host::FitResult cut = host::fit_model(model, set, {.most_steps = 2.0 * pass});
  EXPECT_TRUE(cut.cut_short);
  EXPECT_LE(cut.steps, (2.0 + 2.0 * slopes) * pass);
  EXPECT_LT(cut.steps, free.steps);
  EXPECT_GE(cut.robust, free.robust);
  EXPECT_EQ(cut.model.find("inertia")->at("J"),
            host::fit_model(model, set, {.most_steps = 2.0 * pass}).model.find("inertia")->at("J"))
      << "no clock has a say";
}

TEST(FitBudget, CountsTheStepsInsideASample) {
  const host::Record record = HandMade::record(3.0);
  sim::DriveDescription model = HandMade::model();
  const host::RecordSet set = host::compare_on({&record}, model);
  const double samples = static_cast<double>(set.used_windows() * set.records.front().prepared.windows.front().length);
  EXPECT_EQ(host::steps_of(sim::Drive(model), set), samples);
  // 0.27 radian per step: 2 pi 200 Hz 1 ms / 0.27 = 4.7.
  model.effects.push_back(
      {"compliance", {{"resonance", 200.0}, {"damping_ratio", 0.05}, {"load_fraction", 0.3}}, {}, {}});
  EXPECT_EQ(host::steps_of(sim::Drive(model), set), 5.0 * samples);
  host::RecordSet thin = set;
  thin.stride = set.used_windows();
  EXPECT_EQ(host::steps_of(sim::Drive(model), thin) * static_cast<double>(set.used_windows()), 5.0 * samples);
}

TEST(Fit, LeavesWhatIsHeldAndMovesTheRest) {
  const host::Record record = HandMade::record(3.0);
  sim::DriveDescription model = heavier(HandMade::model());
  model.find("inertia")->held.insert("J");
  const double held = model.find("inertia")->at("J"), friction = model.find("viscous")->at("B");
  const host::RecordSet set = host::compare_on({&record}, model);
  const sim::DriveDescription fitted = host::fit_base(model, set);
  EXPECT_EQ(fitted.find("inertia")->at("J"), held) << "no start may move it either";
  EXPECT_NE(fitted.find("viscous")->at("B"), friction);
  const auto conflicts = host::data_sheet_conflicts(fitted, set);
  ASSERT_EQ(conflicts.size(), 1u);
  EXPECT_EQ(conflicts.front().parameter, "inertia J_kg_m2");
  EXPECT_NEAR(conflicts.front().wanted, held / 1.3, 0.03 * held);
}

// Catches a prior that is ignored, or that gets the weight of all samples.
TEST(Fit, WeighsABeliefAgainstTheRecord) {
  const host::Record record = HandMade::record(3.0);
  sim::DriveDescription model = heavier(HandMade::model());
  const double believed = model.find("inertia")->at("J"), truth = believed / 1.3;
  const host::RecordSet set = host::compare_on({&record}, model);
  const auto fitted_with = [&](double deviation) {
    model.find("inertia")->believed["J"] = {believed, deviation};
    return host::fit_model(model, set).model;
  };
  EXPECT_NEAR(fitted_with(0.3 * believed).find("inertia")->at("J"), truth, 0.02 * truth) << "a vague belief gives way";
  EXPECT_NEAR(fitted_with(1e-6 * believed).find("inertia")->at("J"), believed, 1e-3 * believed);
  const auto conflicts = host::data_sheet_conflicts(fitted_with(0.02 * believed), set);
  ASSERT_EQ(conflicts.size(), 1u) << "the record is eleven deviations off";
  EXPECT_EQ(conflicts.front().known, believed);
}

// Catches a solver that is called with nothing to solve for.
TEST(Fit, ReturnsAModelWhoseParametersAreAllHeld) {
  const host::Record record = HandMade::record(3.0);
  sim::DriveDescription model = heavier(HandMade::model());
  for (sim::EffectEntry& entry : model.effects)
    for (const auto& [id, value] : entry.parameters) entry.held.insert(id);
  const host::RecordSet set = host::compare_on({&record}, model);
  const host::FitResult fit = host::fit_model(model, set);
  EXPECT_EQ(fit.robust, host::error_of(sim::Drive(model), set).robust);
  EXPECT_EQ(fit.model.find("inertia")->at("J"), model.find("inertia")->at("J"));
  EXPECT_TRUE(host::estimate_intervals(model, set).empty());
}

}  // namespace
