// Odds of a run if no rival is the whole truth.
#include "host/plan/decision.hpp"

#include <gtest/gtest.h>

#include "tests/host/plan/plan_trial.hpp"

namespace {

host::RecordSet with_floors_times(double factor, host::RecordSet set) {
  for (host::ComparedRecord& compared : set.records)
    for (std::vector<double>* floor : {&compared.floor.x, &compared.floor.w})
      for (double& value : *floor) value *= factor;
  return set;
}

/// Catches odds that treat a rival as the whole truth. If even the best rival leaves more than the noise floors, then
/// half the noise floors, and so four times the chi^2, are not more evidence.
TEST(Decision, DoesNotTakeForEvidenceWhatNoRivalExplains) {
  const PlanTrial trial = public_trial(std::filesystem::path(AXIS_TEST_DATA) / "drive-cases/single/case-06");
  const std::vector<const host::Record*> training{&trial.training.front()};
  const std::vector<host::Rival> rivals =
      host::fit_rivals(trial.model, training, {{"input_delay"}, {"current_loop_lag"}});
  IndependentDrive drive = trial.drive;
  drive.seed(7);
  IndependentAxis wires(drive, hal::pc::AxisWiring{}.tachometer_resolution);
  host::ExcitedAxis axis(wires, host::design_values(trial.model), trial.model,
                         [&] { drive.advance(trial.model.data.sample_period_s); });
  const host::RunPlan run{{{"steps", {{3.0, -3.0}, {{"hold", 0.1}}}, "", 1.0, 1}}, kTrialBox, {}, 0.0};
  const host::RunOutcome made = host::run_on(axis, run, host::scale_of_drive(trial.model.data));
  ASSERT_TRUE(made.completed) << made.ended;
  const host::RecordSet ground = host::common_ground(training, rivals),
                        anew = host::common_ground({&made.record}, rivals);
  const auto decided = [&](double factor) {
    return host::decide_on(rivals, with_floors_times(factor, ground), with_floors_times(factor, anew));
  };
  const host::Decision as_it_is = decided(1.0), quarter = decided(0.25), eighth = decided(0.125);
  const auto gap = [](const host::Decision& decision) { return decision.chi_square[1] - decision.chi_square[0]; };
  EXPECT_LT(as_it_is.dispersion, 1.3);
  EXPECT_GT(quarter.dispersion, 1.3);
  EXPECT_GT(eighth.dispersion, 2.0 * quarter.dispersion);
  EXPECT_GT(gap(as_it_is), 3.0);
  EXPECT_LE(gap(eighth), gap(quarter));
}

}  // namespace
