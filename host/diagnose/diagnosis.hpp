// Finds the physical effect missing from a model, by how much it lowers the error on held-back data.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/compare/error_regions.hpp"
#include "host/compare/residual_tests.hpp"
#include "host/diagnose/figure_rows.hpp"
#include "host/fit/prepared_sets.hpp"
#include "host/record/measurements.hpp"
#include "host/search/candidate_search.hpp"

namespace host {

struct EffortScreen;
struct TableStudy;

enum class Status { missing, adequate, parameters, ambiguous, unexplained, insufficient_data };

std::string_view status_name(Status status);

/// RMS of the torque or force residual on both sets, Nm or N, if the regression decided.
struct EffortError {
  std::string name;                                  ///< "effort_Nm" or "effort_N"
  double before_train = 0.0, before_validate = 0.0;  ///< of the base, re-fitted
  double after_train = 0.0, after_validate = 0.0;    ///< with the effects of the verdict
  double floor_train = 0.0, floor_validate = 0.0;
};

/// Errors from the log loss of a model (SetError): over the noise floor of the most probable model. Equal to its robust
/// error for that model, and e times as large for one nat more per window and channel.
struct SetLevels {
  double train = 0.0, validate = 0.0;
};

/// A candidate and its result on validation data.
struct JudgedCandidate {
  std::vector<std::string> kinds;
  double before = 0.0;  ///< combined error over the base's noise floors
  double after = 0.0;   ///< over the candidate's own
  double train_after = 0.0;
  SetLevels level;          ///< 0 if the force balance decided
  double confidence = 0.0;  ///< probability that the improvement is not by chance, 0..1
  double luck = 1.0;        ///< p-value of the gain, as the best of all tried candidates, 0..1
  /// Least p-value, 0..1, of the gain of a better candidate with at most one effect more.
  double suffices = 1.0;
  double probability = 0.0;  ///< probability of these effects given these records, 0..1
  sim::DriveDescription model;
  std::vector<std::string> on_bound = {};  ///< parameters that reached a bound of their range
  std::optional<ErrorOnSets> error = {};   ///< as compare prints it; empty if another measure decided
};

/// Combined errors on both sets as they are printed.
struct PrintedError {
  double train = 0.0, validate = 0.0;
};

/// Effects that are certain, and the error before and after they are added, as a share of the signal on held-back
/// records. The signal is the torque or force if the force balance decided, else the channel with the largest error
/// over its noise floor.
struct CertainEffects {
  std::vector<std::string> kinds;
  double probability = 0.0;
  double share_before = 0.0, share_after = 0.0;
};

/// Remaining error of the best model on held-back records.
struct Remains {
  double share = 0.0;       ///< of the signal, as in CertainEffects
  double over_floor = 0.0;  ///< combined error over the noise floor
  std::string coordinate, where;
};

struct DiagnosisVerdict {
  Status status = Status::adequate;
  std::vector<std::string> effects;                    ///< effects to add, best first
  std::vector<std::string> parameters;                 ///< base parameters that were wrong
  std::vector<std::vector<std::string>> alternatives;  ///< groups that these data cannot tell apart
  std::string next_experiment;
  std::string explanation;
  std::vector<CertainEffects> found;    ///< the certain effects, in the order in which they were found
  std::optional<Remains> remains;       ///< error that the named effects leave; empty if only noise remains
  std::string coordinate;               ///< if unexplained: the coordinate that carries most of the residual
  std::string where;                    ///< the range of that coordinate, in words
  double probability_nothing = 0.0;     ///< probability that nothing is missing, 0..1
  std::vector<std::string> data_sheet;  ///< contradictions between data and known values, in words
  double probability_other = 0.0;       ///< probability that the missing effect is no candidate, 0..1
};

/// The inputs and the result of a diagnosis.
struct Diagnosis : PreparedSets {
  Diagnosis() = default;
  explicit Diagnosis(PreparedSets sets) : PreparedSets(std::move(sets)), best(base) {}

  std::vector<LogFault> log;  ///< faults of the records
  bool rough = false;         ///< limited by model error: even the best model is far above the noise floors
  FigureRows rows;
  ErrorOnSets given_error, base_error, best_error;  ///< of the given model, of `base`, of `best`
  std::optional<EffortError> effort;
  double given_train = 0.0, given_validate = 0.0;    ///< combined errors of the given model
  double before_train = 0.0, before_validate = 0.0;  ///< combined errors of the refitted base
  SetLevels base_level;                              ///< of the refitted base
  double after_train = 0.0, after_validate = 0.0;    ///< combined errors with the effects of the verdict
  std::vector<ErrorRegion> where;                    ///< regions of the error of the refitted base, all records
  ResidualTests residual;  ///< how the torque or force residual of `best` depends on each coordinate
  std::size_t tried = 0;   ///< candidates compared on validation data; the others were worse in training
  std::vector<JudgedCandidate> candidates;  ///< best first
  std::vector<std::string> not_searched;    ///< kinds for which a fit ended at its budget, before it converged
  DiagnosisVerdict verdict;
  sim::DriveDescription best;                        ///< with the effects of the verdict; the base if it names none
  std::shared_ptr<const EffortScreen> screen;        ///< result of the force-balance regression; may be absent
  std::shared_ptr<const std::vector<Record>> timed;  ///< records of the sets; time offsets fitted with the effects
  std::shared_ptr<const TableStudy> table;           ///< result of a sensor on the table; empty if there is none
  bool by_effort = false;  ///< the force balance decided; the errors are those of torque or force over sensor noise

  /// Whether candidates were compared by the same error that compare prints.
  bool judged_as_compared() const { return measure == Measure::motion && window_s == kWindow_s; }

  /// Candidates are judged with the measured noise of the sensors, but every model is printed with the error that
  /// compare prints, if this measure decided.
  static PrintedError printed(const JudgedCandidate& candidate) {
    if (!candidate.error) return {candidate.train_after, candidate.after};
    return {candidate.error->train.combined, candidate.error->validate.combined};
  }
  PrintedError printed_base() const {
    if (!judged_as_compared()) return {before_train, before_validate};
    return {base_error.train.combined, base_error.validate.combined};
  }
};

/// Length of the windows for a machine that is limited by model error: 10 ms and at least ten samples. The position
/// over 10 ms shows a force like a low-pass of 100 Hz.
double rough_window_s(const std::vector<const Record*>& records);

/// Whether half of the windows are so far above their noise floors that the machine is limited by model error.
bool is_rough(const SetError& error);

/// Measure for a machine that is limited by model error: torque or force if the model has an inverse and the axis
/// slides for a second in both sets, otherwise motion. `validation` may be empty.
Measure rough_measure(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                      const std::vector<const Record*>& validation);

/// Compares candidates by the motion over windows of kWindow_s. If the machine turns out to be limited by model error,
/// it compares them again by the torque or force, in which a missing effect shows before its error accumulates to a
/// drift; if that is not possible, by the motion over short windows. `before`: an earlier diagnosis of the same
/// records, whose measure is used again, so that the errors can be compared. `absent`: kinds of effects that the
/// machine is known not to have. Throws Failure(bad_input) for records that cannot be compared. Keeps references to the
/// records.
Diagnosis diagnose(const sim::DriveDescription& model, const Measurements& measured, const ShareDone& progress = {},
                   const Diagnosis* before = nullptr, const std::vector<std::string>& absent = {});

/// Diagnosis by the force balance alone, without the search by motion: a first look, usually within a second. Throws
/// Failure(answer_is_no) if the records show no force balance, and what diagnose() throws.
Diagnosis diagnose_quickly(const sim::DriveDescription& model, const Measurements& measured,
                           const std::vector<std::string>& absent = {});

}  // namespace host
