// One trial of planning: an unknown machine, its first record, and the group of remaining explanations.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "hal/pc/simulated_axis.hpp"
#include "host/evidence/measurement_gate.hpp"
#include "host/model/model_file.hpp"
#include "host/plan/experiment_plan.hpp"
#include "host/plan/simulated_run.hpp"
#include "host/record/read_record.hpp"
#include "tests/host/plan/drive_cases.hpp"

struct PlanTrial {
  std::string name, truth;
  std::vector<std::string> group;
  sim::DriveDescription model;
  std::vector<host::Record> training;
  IndependentDrive drive;
  double jogs_s = 0.0;  ///< duration of the fixed jogs of the case
};

/// Result for one pair of the group.
struct PairOutcome {
  std::string a, b;
  bool separable = false, by_hand = false;
  double expected = 1.0, came = 1.0;
  bool right = false;  ///< the true one won; meaningless if neither is true
};

struct TrialOutcome {
  host::Plan plan;
  bool completed = false;
  double recorded_s = 0.0, computed_s = 0.0;
  std::string best;
  std::vector<PairOutcome> pairs;  ///< pairs that contain the truth
  double error = 0.0;
};

inline const host::ExcitationLimits kTrialBox{80.0, 200.0, 4.0, 10.0};

/// A case of the public folder. Its first record is that of a new machine.
inline PlanTrial public_trial(const std::filesystem::path& folder) {
  PlanTrial trial;
  const auto truth = nlohmann::json::parse(std::ifstream(folder / "truth.json"));
  trial.name = folder.filename();
  trial.truth = truth["effects"][0];
  trial.group = truth["groups"][0].get<std::vector<std::string>>();
  trial.model = host::read_model(folder / "model.toml");
  const bool has_steps = std::filesystem::exists(folder / "train-steps.csv");
  trial.training = host::MeasurementGate(trial.model)
                       .read({folder / (has_steps ? "train-steps.csv" : "train-sweep.csv")})
                       .training();
  const host::Record jogs = host::read_record(folder / "train-jog.csv");
  trial.jogs_s = jogs.t_s.back() - jogs.t_s.front();
  trial.drive = drive_of_truth(truth);
  put_data_sheet(trial.drive, trial.model.data);
  return trial;
}

/// The same machine with another member of the group, and the first record that it would have given.
inline PlanTrial with_other_truth(PlanTrial trial, const std::string& name, const std::string& truth,
                                  const IndependentDrive& drive) {
  trial.name = name;
  trial.truth = truth;
  trial.drive = drive;
  for (host::Record& record : trial.training) record = replayed(drive, record);
  return trial;
}

inline PlanTrial with_load_dependent_friction(const PlanTrial& trial) {
  IndependentDrive drive = trial.drive;
  drive.dead_zone = 0.0;
  drive.friction_per_torque = 0.08;
  return with_other_truth(trial, trial.name + " load", "load_dependent_friction", drive);
}

/// One of three effects that cannot be told apart on a drive without static friction.
inline PlanTrial with_level(PlanTrial trial, const std::string& truth, double share) {
  IndependentDrive drive = trial.drive;
  drive.delay_s = drive.load = 0.0;
  const double level = 0.5 * (drive.coulomb_positive + drive.coulomb_negative);
  if (truth == "constant_torque") drive.load = share * level;
  if (truth == "dac_offset") drive.dac_offset = share * level / drive.torque_per_volt;
  if (truth == "coulomb_asymmetry") {
    drive.coulomb_positive = (1.0 + share) * level;
    drive.coulomb_negative = (1.0 - share) * level;
  }
  trial.group = {"constant_torque", "coulomb_asymmetry", "dac_offset"};
  return with_other_truth(trial, trial.name + " " + truth.substr(0, 8), truth, drive);
}

/// The machine with a delay (s) or a current loop (Hz).
inline PlanTrial with_delay(const PlanTrial& trial, double delay_s) {
  IndependentDrive drive = trial.drive;
  drive.delay_s = delay_s;
  drive.current_bandwidth_Hz = 0.0;
  return with_other_truth(trial, fmt::format("{} {:g} ms", trial.name, 1e3 * delay_s), "input_delay", drive);
}
inline PlanTrial with_lag(const PlanTrial& trial, double bandwidth_Hz) {
  IndependentDrive drive = trial.drive;
  drive.delay_s = 0.0;
  drive.current_bandwidth_Hz = bandwidth_Hz;
  return with_other_truth(trial, fmt::format("{} {:g} Hz", trial.name, bandwidth_Hz), "current_loop_lag", drive);
}

inline TrialOutcome carried_out(const PlanTrial& trial) {
  const std::clock_t begun = std::clock();
  TrialOutcome outcome;
  std::vector<const host::Record*> training;
  for (const host::Record& record : trial.training) training.push_back(&record);
  std::vector<std::vector<std::string>> kinds;
  for (const std::string& kind : trial.group) kinds.push_back({kind});
  outcome.plan = host::plan_run(trial.model, training, host::fit_rivals(trial.model, training, kinds), kTrialBox);
  const host::Plan& plan = outcome.plan;
  std::vector<double> probability(plan.rivals.size(), 1.0);
  if (plan.separable) {
    IndependentDrive drive = trial.drive;
    drive.seed(7);
    const double period_s = trial.model.data.sample_period_s;
    IndependentAxis wires(drive, hal::pc::AxisWiring{}.tachometer_resolution);
    host::ExcitedAxis axis(wires, host::design_values(trial.model), trial.model, [&] { drive.advance(period_s); });
    const host::RunOutcome made = host::run_on(axis, plan.run, host::scale_of_drive(trial.model.data));
    outcome.completed = made.completed;
    outcome.recorded_s = static_cast<double>(made.record.size()) * period_s;
    const host::Decision decision = host::decide(plan.rivals, training, made.record);
    outcome.best = host::rival_name(decision.rivals[decision.best].kinds);
    outcome.error = decision.error;
    for (std::size_t k = 0; k < probability.size(); ++k) probability[k] = decision.rivals[k].probability;
  }
  for (const host::PairOutlook& pair : plan.pairs) {
    const std::string a = host::rival_name(plan.rivals[pair.a].kinds), b = host::rival_name(plan.rivals[pair.b].kinds);
    if (a != trial.truth && b != trial.truth) continue;
    const double odds =
        a == trial.truth ? probability[pair.a] / probability[pair.b] : probability[pair.b] / probability[pair.a];
    outcome.pairs.push_back({a == trial.truth ? a : b, a == trial.truth ? b : a, pair.separable, !pair.by_hand.empty(),
                             a == trial.truth ? pair.odds_if_a : pair.odds_if_b, std::min(odds, host::kHighestOdds),
                             odds > 1.0});
  }
  outcome.computed_s = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  return outcome;
}
