#include "host/diagnose/diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "host/compare/residual_tests.hpp"
#include "host/diagnose/diagnosis_json.hpp"
#include "host/diagnose/improvement.hpp"
#include "host/fit/prepared_sets.hpp"
#include "host/scoreboard/simulated_null.hpp"
#include "sim/curve.hpp"
#include "tests/host/diagnose/drive_case.hpp"
#include "tests/host/evidence/hand_made_record.hpp"

namespace {

using testing::Contains;
using testing::IsEmpty;

TEST(Diagnosis, AWrongInertiaIsAParameterAndNoEffect) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  DriveCase nothing_hidden("none/case-00");
  const double given = nothing_hidden.model.find("inertia")->parameters["J"] *= 1.2;
  const host::Diagnosis diagnosis = nothing_hidden.diagnose();
  EXPECT_EQ(diagnosis.verdict.status, host::Status::parameters) << diagnosis.verdict.explanation;
  EXPECT_THAT(diagnosis.verdict.parameters, Contains("inertia"));
  EXPECT_THAT(diagnosis.verdict.effects, IsEmpty());
  // truth.json: 0.00992 kg m^2.
  EXPECT_NEAR(diagnosis.base.find("inertia")->at("J"), 0.0099187, 0.02 * 0.0099187);
  EXPECT_GT(given, 1.15 * 0.0099187);
  EXPECT_LT(diagnosis.before_validate, diagnosis.given_validate);
}

TEST(Diagnosis, AnAxisThatStandsTellsNothing) {
  host::Record record = HandMade::record(5.0);
  std::ranges::fill(record.x, 12.0);
  std::ranges::fill(record.u_V, 0.1);
  for (std::size_t k = 0; k < record.size(); ++k) record.w[k] = 0.1 * std::sin(1.7 * static_cast<double>(k));
  const sim::DriveDescription model = HandMade::model();
  const host::Measurements measured = host::MeasurementGate(model).admit({record});
  const host::Diagnosis diagnosis = host::diagnose(model, measured);
  EXPECT_EQ(diagnosis.verdict.status, host::Status::insufficient_data);
  EXPECT_TRUE(diagnosis.held_back);
  EXPECT_THAT(diagnosis.verdict.effects, IsEmpty());
  EXPECT_THAT(diagnosis.candidates, IsEmpty());
  EXPECT_THAT(diagnosis.verdict.next_experiment, testing::HasSubstr("V"));
}

TEST(Diagnosis, ATachometerWithoutADataSheetHasTheNoiseThatItsRecordShows) {
  host::Record record = HandMade::record(5.0);
  std::ranges::fill(record.x, 12.0);
  std::ranges::fill(record.u_V, 0.1);
  for (std::size_t k = 0; k < record.size(); ++k) record.w[k] = 0.1 * std::sin(1.7 * static_cast<double>(k));
  sim::DriveDescription model = HandMade::model();
  model.data.tach_noise_variance.reset();
  const host::Measurements measured = host::MeasurementGate(model).admit({record});
  const host::Diagnosis diagnosis = host::diagnose(model, measured);
  EXPECT_LT(diagnosis.given_train, 2.0) << "no axis stands without noise";
  EXPECT_LT(diagnosis.given_validate, 2.0);
}

/// A drive with a dead time and a dead zone of `width_V`: it follows a command that is larger by this width.
DriveCase late_with_dead_zone(double width_V) {
  DriveCase late("single/case-06");
  for (std::vector<host::Record>* records : {&late.train, &late.validate})
    for (host::Record& record : *records)
      for (double& u_V : record.u_V)
        if (u_V != 0.0) u_V += std::copysign(width_V, u_V);
  return late;
}

/// While the axis slides, the force balance shows only the dead time.
TEST(Diagnosis, WhatTheEffortLeavesTheMotionTells) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  DriveCase late = late_with_dead_zone(0.2);
  const host::Diagnosis diagnosis = late.diagnose();
  EXPECT_EQ(diagnosis.verdict.status, host::Status::missing) << diagnosis.verdict.explanation;
  EXPECT_THAT(diagnosis.verdict.effects, testing::UnorderedElementsAre("input_delay", "dac_dead_zone"));
  EXPECT_LT(diagnosis.after_validate, 1.1);
}

/// Effects that are often confused with the first of two effects are also tried in its place, beside the second.
TEST(Diagnosis, BothEffectsOfAPairHaveRivals) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  DriveCase late = late_with_dead_zone(0.12);
  const host::Diagnosis diagnosis = late.diagnose();
  const auto judged = [&](const std::vector<std::string>& kinds) {
    return std::ranges::any_of(diagnosis.candidates,
                               [&](const auto& one) { return std::ranges::is_permutation(one.kinds, kinds); });
  };
  EXPECT_TRUE(judged({"input_delay", "dac_dead_zone"}));
  EXPECT_TRUE(judged({"current_loop_lag", "dac_dead_zone"}));
}

TEST(Diagnosis, WhatTheTrainingDataLeaveOpenOfTheBaseIsNoEffect) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  // The friction from the training motion is wrong for the validation motion.
  const host::SimulatedNull null = host::simulated_null(3'000'054);
  const host::Measurements measured = host::MeasurementGate(null.model).admit(null.train, null.validate);
  const host::Diagnosis diagnosis = host::diagnose(null.model, measured);
  EXPECT_GT(diagnosis.before_validate, 5.0) << "nothing is left open here";
  EXPECT_EQ(diagnosis.verdict.status, host::Status::insufficient_data) << diagnosis.verdict.explanation;
  EXPECT_THAT(diagnosis.verdict.explanation,
              testing::ContainsRegex("training data do not determine [a-z, ]*(viscous|stribeck)"));
}

/// The base ends in a local minimum, which a fit leaves only with a nonexistent offset. A candidate based on it
/// diverges.
TEST(Diagnosis, ABaseThatWasStuckIsNotTakenForAMissingEffect) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::SimulatedNull null = host::simulated_null(55);
  const host::Measurements measured = host::MeasurementGate(null.model).admit(null.train, null.validate);
  const host::Diagnosis diagnosis = host::diagnose(null.model, measured);
  EXPECT_LT(diagnosis.before_train, 1.0) << "of the base, re-fitted";
  EXPECT_EQ(diagnosis.verdict.status, host::Status::parameters) << diagnosis.verdict.explanation;
}

/// A diverged breakaway level distorted the base so much that half of the error was called an effect. Without it, the
/// training data do not determine the base, and the verdict says so.
TEST(Diagnosis, ABaseThatWasStuckIsFreedWhateverItsJudgesSay) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::SimulatedNull null = host::simulated_null(2'000'049);
  const host::Measurements measured = host::MeasurementGate(null.model).admit(null.train, null.validate);
  const host::Diagnosis diagnosis = host::diagnose(null.model, measured);
  EXPECT_LT(diagnosis.before_train, 1.0) << "of the base, re-fitted";
  EXPECT_THAT(diagnosis.verdict.effects, IsEmpty()) << diagnosis.verdict.explanation;
}

/// Static friction diverged to the full torque of the motor, and no candidate recovered from that.
TEST(Diagnosis, StaticFrictionThatRanAwayIsFittedAgainFromWhatWasGiven) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::SimulatedNull null = host::simulated_null(1'000'040);
  const host::Measurements measured = host::MeasurementGate(null.model).admit(null.train, null.validate);
  const host::Diagnosis diagnosis = host::diagnose(null.model, measured);
  EXPECT_LT(diagnosis.before_train, 1.0) << "of the base, re-fitted";
  EXPECT_LT(diagnosis.base.find("stribeck")->at("static_positive"), 6.0) << "4.4 Nm in the machine";
}

/// Half of the residual depends on the acceleration because of the smoother; no effect is missing.
TEST(Diagnosis, WhatTheSmootherRoundsOffIsNoEffect) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const host::SimulatedNull null = host::simulated_null(3);
  const host::Measurements measured = host::MeasurementGate(null.model).admit(null.train, null.validate);
  const host::Diagnosis diagnosis = host::diagnose(null.model, measured);
  EXPECT_LT(diagnosis.before_validate, 1.0);
  EXPECT_NE(diagnosis.verdict.status, host::Status::unexplained) << diagnosis.verdict.explanation;
}

TEST(Diagnosis, WhatACompleteModelLeavesDependsOnNothing) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const DriveCase complete("none/case-00");
  std::vector<const host::Record*> train, validate;
  for (const host::Record& record : complete.train) train.push_back(&record);
  for (const host::Record& record : complete.validate) validate.push_back(&record);
  const host::PreparedSets sets = host::prepare_sets(complete.model, train, validate);
  const host::ResidualTests tests = host::test_residuals(sets.base, sets.training, sets.validation);
  ASSERT_FALSE(tests.dependences.empty());
  for (const host::ResidualDependence& dependence : tests.dependences) {
    if (dependence.coordinate == "acceleration") continue;
    EXPECT_LT(dependence.share, 0.1) << dependence.coordinate;
  }
}

TEST(Diagnosis, ARippleOverTheTravelIsSeenThoughBinsOverAllOfItAreTooWide) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  const DriveCase cogging("single/case-00");
  std::vector<const host::Record*> train, validate;
  for (const host::Record& record : cogging.train) train.push_back(&record);
  for (const host::Record& record : cogging.validate) validate.push_back(&record);
  const host::PreparedSets sets = host::prepare_sets(cogging.model, train, validate);
  const host::ResidualTests tests = host::test_residuals(sets.base, sets.training, sets.validation);
  const auto position = std::ranges::find(tests.dependences, "position", &host::ResidualDependence::coordinate);
  ASSERT_NE(position, tests.dependences.end());
  EXPECT_GT(position->share, 0.1);
  double period_mm = 0.0;
  ASSERT_EQ(std::sscanf(position->where.c_str(), "every %lf mm", &period_mm), 1) << position->where;
  EXPECT_NEAR(period_mm, 1.25, 0.0125) << "truth.json; of ten periods, a tenth of one";
}

/// A hard spot, which the catalogue does not contain. The motion is the one under the recorded command; with the spot,
/// this motion would have needed more torque there.
void add_hard_spot(host::Record& record, const sim::DataSheet& data, double place_mm, double width_mm,
                   double effort_Nm) {
  constexpr double kSliding_rad_s = 0.5;
  for (std::size_t k = 0; k < record.size(); ++k) {
    const double distance = (record.x[k] - place_mm) / width_mm;
    const double direction = record.w[k] > kSliding_rad_s ? 1.0 : record.w[k] < -kSliding_rad_s ? -1.0 : 0.0;
    record.u_V[k] += effort_Nm * direction * std::exp(-distance * distance) / data.effort_per_volt();
  }
}

TEST(Diagnosis, AnEffectOutsideTheCatalogueIsUnexplainedAndItsPlaceIsNamed) {
  AXIS_SKIP_WHERE_INSTRUMENTED();
  constexpr double place_mm = -10.0;
  DriveCase spoilt("none/case-00");
  for (auto* records : {&spoilt.train, &spoilt.validate})
    for (host::Record& record : *records) add_hard_spot(record, spoilt.model.data, place_mm, 3.0, 1.0);
  const host::Diagnosis diagnosis = spoilt.diagnose();
  EXPECT_EQ(diagnosis.verdict.status, host::Status::unexplained) << diagnosis.verdict.explanation;
  EXPECT_THAT(diagnosis.verdict.effects, IsEmpty());
  const host::ErrorRegion* worst = host::worst_region(diagnosis.where);
  ASSERT_NE(worst, nullptr);
  EXPECT_EQ(worst->partition, "place");
  double from_mm = 0.0, to_mm = 0.0;
  ASSERT_EQ(std::sscanf(worst->region.c_str(), "x = %lf to %lf mm", &from_mm, &to_mm), 2) << worst->region;
  EXPECT_LT(from_mm, place_mm);
  EXPECT_GT(to_mm, place_mm);
  EXPECT_LT(to_mm - from_mm, 15.0);  // of 150 mm of travel
  // A curve of the friction along the travel has a peak there, and is flat elsewhere.
  const host::Addition added =
      host::add_free_curve(spoilt.model, "friction_along_position",
                           host::MeasurementGate(spoilt.model).admit(spoilt.train, spoilt.validate));
  EXPECT_LT(added.judged.after, 0.7 * added.judged.before);
  EXPECT_GT(added.judged.confidence, 0.95);
  const sim::Curve curve(added.judged.model.effects.back());
  EXPECT_NEAR(curve(place_mm), 1.0, 0.3);
  EXPECT_NEAR(curve(place_mm - 30.0), 0.0, 0.15);
  EXPECT_NEAR(curve(place_mm + 30.0), 0.0, 0.15);
  // The JSON document also contains the coordinate.
  const nlohmann::json residual = host::to_json(diagnosis).at("residual");
  EXPECT_GT(residual.at("dependences").at(0).at("share").get<double>(), 0.1);
  const nlohmann::json& with_itself = residual.at("autocorrelation");
  EXPECT_NEAR(with_itself.at("value").at(0).get<double>(), 1.0, 1e-9);
  EXPECT_EQ(with_itself.at("value").size(), with_itself.at("lag_s").size());
  EXPECT_GT(with_itself.at("bound").get<double>(), 0.0);
}

}  // namespace
