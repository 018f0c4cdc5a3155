// Which physical effect is missing from a model, by how much it lowers the error on data that its fit never saw.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/compare/error_regions.hpp"
#include "host/compare/residual_tests.hpp"
#include "host/diagnose/candidate_search.hpp"
#include "host/diagnose/prepared_sets.hpp"
#include "host/record/measurements.hpp"

namespace host {

struct EffortScreen;

enum class Status { missing, adequate, parameters, ambiguous, unexplained, insufficient_data };

std::string_view status_name(Status status);

/// RMS of one measured channel (or of the effort, where that is the measure) on both sets, in its own unit, beside what
/// the best possible model would leave.
struct ChannelError {
  std::string name;                                  ///< column name, e.g. "w_rad_s"
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

struct DiagnosisVerdict {
  Status status = Status::adequate;
  std::vector<std::string> effects;                    ///< what to add, best first
  std::vector<std::string> parameters;                 ///< base parameters that were off
  std::vector<std::vector<std::string>> alternatives;  ///< groups that these data cannot tell apart
  std::string next_experiment;
  std::string explanation;
  std::string coordinate;               ///< where unexplained: what carries most of what is left
  std::string where;                    ///< where along it, in words
  double probability_nothing = 0.0;     ///< that nothing is missing, 0..1
  std::vector<std::string> data_sheet;  ///< where the data fight what the model file holds or believes, in words
  double probability_other = 0.0;       ///< that something is missing that is no candidate, 0..1
};

/// What it began with, and what came of it.
struct Diagnosis : PreparedSets {
  Diagnosis() = default;
  explicit Diagnosis(PreparedSets sets) : PreparedSets(std::move(sets)), best(base) {}

  std::vector<LogFault> log;  ///< what is doubtful about the records
  bool rough = false;  ///< even the best model stays far above the floors: what is missing, not noise, sets the limit
  std::vector<ChannelError> channels;
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
  sim::DriveDescription best;                  ///< with the effects of the verdict; the base where there are none
  std::shared_ptr<const EffortScreen> screen;  ///< what plain least squares of the effort saw; may be absent
  bool by_effort = false;                      ///< that decided: errors are then of the effort over its sensors' noise
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

}  // namespace host
