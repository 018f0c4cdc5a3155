// The steps of a commissioning, one file each. They pass results through files of the folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/commission/session.hpp"
#include "host/record/measurements.hpp"
#include "host/response/compliance.hpp"

namespace host {

struct CommissionStepResult {
  std::vector<std::string> files;  ///< in the folder
  std::string said;                ///< result in one or two sentences
};

/// Makes before-params.toml (the board as it was), standstill.csv, pulse.csv, look.json. Throws Failure(refused) if
/// feedback and motor have opposite signs.
CommissionStepResult look(CommissionSession& session);

/// Makes steps.csv, identified.toml, identification.json.
CommissionStepResult identify_first(CommissionSession& session);

/// Makes first-params.toml, and downloads it.
CommissionStepResult control_first(CommissionSession& session);

/// If homing is possible: homes the axis and makes steps.csv again. From now on positions count from home.
CommissionStepResult home_axis(CommissionSession& session);

/// Makes ladder-slow.csv, ladder-fast.csv.
CommissionStepResult climb_ladder(CommissionSession& session);

/// Makes model.toml, with the friction from the jogs if they determine it.
CommissionStepResult find_friction(CommissionSession& session);

/// The jogs may not determine the static friction (its interval is wider than its value), for example when magnets
/// distort the slowest ones. It may then come out as thirty times the sliding friction, from which no fit recovers. In
/// that case uses the breakaway voltage of each direction, falling to the sliding friction over the one known speed.
/// Returns whether that was needed.
bool level_static_friction(sim::DriveDescription& model, double forward_V, double backward_V);

/// Makes response.json, response.html, raised-params.toml and response-after.json. Later steps use a faster controller
/// if the measured response allows one and the machine confirms it.
CommissionStepResult measure_response(CommissionSession& session);

/// The controller with `options` for `model`: if a faster loop was confirmed, as fast as the measured response allows,
/// with that loop's notch. Throws Failure(refused) if no bandwidth keeps the margin.
CommissionLoop measured_loop(CommissionSession& session, const sim::DriveDescription& model,
                             const DesignOptions& options);

/// The same; the first controller if no bandwidth keeps the margin.
CommissionLoop raised_loop(CommissionSession& session, const sim::DriveDescription& model,
                           const DesignOptions& options);

/// Compliance of the axis with a controller, from the measured response; without one, from `model`.
Compliance compliance_with(CommissionSession& session, const sim::DriveDescription& model,
                           const firmware::AxisParameters<float>& controller);

/// Makes the other training records (kTrainingFiles) and the validation records (kJudgingFiles).
CommissionStepResult record_validation(CommissionSession& session);

/// Makes comparison.json.
CommissionStepResult compare_first(CommissionSession& session);

/// Makes diagnosis.json, diagnosis.html.
CommissionStepResult diagnose_machine(CommissionSession& session);

/// If the diagnosis is ambiguous and a motion in the box separates: makes plan-N.json, run-N.toml, run-N.csv,
/// decision-N.json, and decided.toml if one explanation remains.
CommissionStepResult separate(CommissionSession& session);

/// Makes improved.toml, improvement.json, improvement.html.
CommissionStepResult improve_model(CommissionSession& session);

/// Makes estimator-N-params.toml, estimator-N.csv, estimator-N-again.csv, estimator.json: a disturbance variance, and
/// the tachometer's measured one, for compensate() to compare. Makes nothing if the box's time would not suffice.
CommissionStepResult tune_estimator(CommissionSession& session);

/// Makes the same jogs with at most five sets of parameters, twice each: before (old-params.toml), loop (base model
/// with tuned bandwidth and estimator), untuned (improved model, first estimator), after (all of it, new-params.toml),
/// first-loop (improved model, first loop, only if no other set with that model gains). Makes NAME.csv, NAME-again.csv
/// and errors.json; leaves the best set on the board. The first set stays unless another is better by more than equal
/// runs differ.
CommissionStepResult compensate(CommissionSession& session);

/// Makes page.html.
CommissionStepResult write_page(CommissionSession& session);

inline const std::vector<std::string> kTrainingFiles{"steps.csv", "ladder-slow.csv", "ladder-fast.csv",
                                                     "sweep.csv", "reversals.csv",   "dwell.csv"};
inline const std::vector<std::string> kJudgingFiles{"judge-jogs.csv", "judge-again.csv", "judge-steps.csv"};

/// A record of a run that the step separate planned: further training.
inline bool is_planned_run(std::string_view file) { return file.starts_with("run-") && file.ends_with(".csv"); }

/// All training and validation records, checked by the gate, including the runs that separate explanations.
Measurements read_measurements(CommissionSession& session, const sim::DriveDescription& model);

/// Makes voltage steps in open loop: steps.csv.
Record record_steps(CommissionSession& session);

/// The motion for comparing controllers; always the same.
CommissionRun judging_jogs(const CommissionSession& session, const std::string& file);

}  // namespace host
