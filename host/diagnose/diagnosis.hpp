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
#include "host/diagnose/candidate_search.hpp"
#include "host/diagnose/figure_rows.hpp"
#include "host/diagnose/prepared_sets.hpp"
#include "host/record/measurements.hpp"

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

/// A candidate as it was judged on validation data.
struct JudgedCandidate {
  std::vector<std::string> kinds;
  double before = 0.0;  ///< combined
  double after = 0.0;
  double train_after = 0.0;
  double train_after_robust = 0.0;  ///< SetError::robust; 0 where the effort was judged
  double confidence = 0.0;          ///< that the improvement is no luck, 0..1
  double luck = 1.0;                ///< probability that the best of all that were tried gains as much by chance, 0..1
  double probability = 0.0;         ///< of this mechanism given these records, 0..1
  sim::DriveDescription model;
  std::vector<std::string> on_bound = {};  ///< parameters that ran to the end of their range
};

/// Effects that are certain, and the share of the signal that the error is before and after them, on held-back records:
/// of the torque or force where that was judged, else of the channel that is farthest above its noise floor.
struct CertainEffects {
  std::vector<std::string> kinds;
  double probability = 0.0;
  double share_before = 0.0, share_after = 0.0;
};

/// What the best model leaves on held-back records.
struct Remains {
  double share = 0.0;       ///< of the signal, as in CertainEffects
  double over_floor = 0.0;  ///< combined error over the noise floor
  std::string coordinate, where;
};

struct DiagnosisVerdict {
  Status status = Status::adequate;
  std::vector<std::string> effects;                    ///< what to add, best first
  std::vector<std::string> parameters;                 ///< base parameters that were off
  std::vector<std::vector<std::string>> alternatives;  ///< groups that these data cannot tell apart
  std::string next_experiment;
  std::string explanation;
  std::vector<CertainEffects> found;    ///< what is certain, in the order in which it was found
  std::optional<Remains> remains;       ///< beside named effects: what they leave; empty where only noise is left
  std::string coordinate;               ///< where unexplained: what carries most of what is left
  std::string where;                    ///< where along it, in words
  double probability_nothing = 0.0;     ///< that nothing is missing, 0..1
  std::vector<std::string> data_sheet;  ///< where the data fight what the model file holds or believes, in words
  double probability_other = 0.0;       ///< that something is missing that is no candidate, 0..1
};

/// Start and result.
struct Diagnosis : PreparedSets {
  Diagnosis() = default;
  explicit Diagnosis(PreparedSets sets) : PreparedSets(std::move(sets)), best(base) {}

  std::vector<LogFault> log;  ///< what is doubtful about the records
  bool rough = false;  ///< even the best model stays far above the floors: what is missing, not noise, sets the limit
  FigureRows rows;
  ErrorOnSets given_error, base_error, best_error;  ///< of the model as it was given, of `base`, of `best`
  std::optional<EffortError> effort;
  double given_train = 0.0, given_validate = 0.0;    ///< combined, of the model as it was given
  double before_train = 0.0, before_validate = 0.0;  ///< combined, of the base re-fitted
  double before_train_robust = 0.0;                  ///< SetError::robust; 0 where the effort was judged
  double after_train = 0.0, after_validate = 0.0;    ///< combined, with the effects of the verdict
  std::vector<ErrorRegion> where;                    ///< of the base re-fitted, on all records
  ResidualTests residual;                            ///< of `best`: what depends on what in the effort that it leaves
  std::size_t tried = 0;  ///< candidates that validation data judged; the others fell behind in training
  std::vector<JudgedCandidate> candidates;  ///< best first
  std::vector<std::string> not_searched;    ///< kinds of which a fit ended at its budget, not at its best
  DiagnosisVerdict verdict;
  sim::DriveDescription best;                        ///< with the effects of the verdict; the base where there are none
  std::shared_ptr<const EffortScreen> screen;        ///< what plain least squares of the effort saw; may be absent
  std::shared_ptr<const std::vector<Record>> timed;  ///< the records of the sets, timed beside what was found
  std::shared_ptr<const TableStudy> table;           ///< what a sensor on the table shows; empty without one
  bool by_effort = false;  ///< that decided: errors are then of the effort over its sensors' noise

  /// Whether candidates were compared by the error that compare prints.
  bool judged_as_compared() const { return measure == Measure::motion && window_s == kWindow_s; }

  /// A combined error that judged held-back records, in the measure of `base_error`: candidates are judged over the
  /// noise floors of the best of them, a model alone is told over its own.
  double told(double judged) const {
    const double now = base_error.validate.combined;
    return judged_as_compared() && before_validate > 0.0 && now > 0.0 ? judged * now / before_validate : judged;
  }
  double told_of_training(double judged) const {
    const double now = base_error.train.combined;
    return judged_as_compared() && before_train > 0.0 && now > 0.0 ? judged * now / before_train : judged;
  }
};

/// Windows of a machine whose missing effects, not its sensors, set the limit: 10 ms, in which the position shows a
/// force as a low-pass of 100 Hz would, and ten samples at least.
double rough_window_s(const std::vector<const Record*>& records);

/// Whether half of the windows lie far above their floors: on such a machine what is missing, not noise, sets the
/// limit.
bool is_rough(const SetError& error);

/// What a rough machine is judged by: the effort, where the model has an inverse and both sets slide for a second.
/// `validation` may be empty.
Measure rough_measure(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                      const std::vector<const Record*>& validation);

/// By the motion over windows of kWindow_s. Where the machine proves rough, again by the effort, in which what is
/// missing shows before it adds up to a drift; and where that says nothing, by the motion over short windows. `before`:
/// an earlier diagnosis of the same records, whose way of judging is taken over, so that their errors can be compared.
/// `absent`: kinds of effects that the machine is known not to have.
/// Throws Failure(bad_input) for records that cannot be compared. Keeps references to the records.
Diagnosis diagnose(const sim::DriveDescription& model, const Measurements& measured, const ShareDone& progress = {},
                   const Diagnosis* before = nullptr, const std::vector<std::string>& absent = {});

/// What the force balance alone shows, without the search by motion: most of its probabilities within a second.
/// Throws Failure(answer_is_no) where the records show no force balance, and what diagnose() throws.
Diagnosis diagnose_quickly(const sim::DriveDescription& model, const Measurements& measured,
                           const std::vector<std::string>& absent = {});

}  // namespace host
