// The steps of a commissioning, one file each. They pass results through files of the folder.
#pragma once

#include <string>
#include <vector>

#include "host/commission/session.hpp"
#include "host/record/measurements.hpp"

namespace host {

struct CommissionStepResult {
  std::vector<std::string> files;  ///< in the folder
  std::string said;                ///< what was found, a sentence or two
};

/// Makes before-params.toml (the board as it was), standstill.csv, pulse.csv, look.json. Throws Failure(refused) where
/// feedback and motor disagree.
CommissionStepResult look(CommissionSession& session);

/// Makes steps.csv, identified.toml, identification.json.
CommissionStepResult identify_first(CommissionSession& session);

/// Makes first-params.toml, and downloads it.
CommissionStepResult control_first(CommissionSession& session);

/// Where something finds home: makes steps.csv again, counted from there; every later motion is.
CommissionStepResult home_axis(CommissionSession& session);

/// Makes ladder-slow.csv, ladder-fast.csv.
CommissionStepResult climb_ladder(CommissionSession& session);

/// Makes model.toml, with the friction from the jogs if they determine it.
CommissionStepResult find_friction(CommissionSession& session);

/// Static friction that the jogs leave undetermined (its interval is wider than its value), as where magnets bend the
/// slowest of them, may come out at thirty times what slides, and no fit finds back from there: instead what broke the
/// axis away, in volts each way, falling to what slides over the one speed that is known. Whether that was needed.
bool level_static_friction(sim::DriveDescription& model, double forward_V, double backward_V);

/// Makes response.json, response.html, raised-params.toml, response-after.json, and leaves a livelier controller to
/// the later steps where the measured response allows one and the machine agrees.
CommissionStepResult measure_response(CommissionSession& session);

/// What the measured response allows for `model`; the first loop where it allowed none, or was not measured.
CommissionLoop raised_loop(CommissionSession& session, const sim::DriveDescription& model);

/// Makes the other training records (kTrainingFiles) and the validation records (kJudgingFiles).
CommissionStepResult record_validation(CommissionSession& session);

/// Makes comparison.json.
CommissionStepResult compare_first(CommissionSession& session);

/// Makes diagnosis.json, diagnosis.html.
CommissionStepResult diagnose_machine(CommissionSession& session);

/// Where the diagnosis is ambiguous and a motion in the box separates: makes plan-N.json, run-N.toml, run-N.csv,
/// decision-N.json, and decided.toml where one explanation is left.
CommissionStepResult separate(CommissionSession& session);

/// Makes improved.toml, improvement.json, improvement.html.
CommissionStepResult improve_model(CommissionSession& session);

/// Makes old-params.toml, new-params.toml, before.csv, after.csv, errors.json; leaves the better set on the board.
CommissionStepResult compensate(CommissionSession& session);

/// Makes page.html.
CommissionStepResult write_page(CommissionSession& session);

inline const std::vector<std::string> kTrainingFiles{"steps.csv", "ladder-slow.csv", "ladder-fast.csv",
                                                     "sweep.csv", "reversals.csv",   "dwell.csv"};
inline const std::vector<std::string> kJudgingFiles{"judge-jogs.csv", "judge-again.csv", "judge-steps.csv"};

/// All training and validation records, through the gate, with the runs that separate explanations.
Measurements read_measurements(CommissionSession& session, const sim::DriveDescription& model);

/// Steps of voltage in open loop: steps.csv.
Record record_steps(CommissionSession& session);

/// The motion for comparing controllers; always the same.
CommissionRun judging_jogs(const CommissionSession& session, const std::string& file);

}  // namespace host
