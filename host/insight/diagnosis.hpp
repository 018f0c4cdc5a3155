// Which physical effect is missing from a model, by how much it lowers the error on data that its fit never saw.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/insight/candidate_search.hpp"
#include "host/insight/error_regions.hpp"

namespace host {

enum class Status { missing, adequate, parameters, ambiguous, unexplained, insufficient_data };

std::string_view status_name(Status status);

/// RMS of one measured channel on both sets, in its own unit, beside what the best possible model would leave.
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
  double confidence = 0.0;  ///< that the improvement is no luck, 0..1
  sim::DriveDescription model;
};

struct DiagnosisVerdict {
  Status status = Status::adequate;
  std::vector<std::string> effects;                    ///< what to add, best first
  std::vector<std::string> parameters;                 ///< base parameters that were off
  std::vector<std::vector<std::string>> alternatives;  ///< groups that these data cannot tell apart
  std::string next_experiment;
  std::string explanation;
};

struct Diagnosis {
  double window_s = kWindow_s;
  bool rough = false;  ///< even the best model stays far above the floors: what is missing, not noise, sets the limit
  bool held_back = false;  ///< no validation record was given: blocks of the training data were kept back
  std::vector<ChannelError> channels;
  double given_train = 0.0, given_validate = 0.0;    ///< combined, of the model as it was given
  double before_train = 0.0, before_validate = 0.0;  ///< combined, of the base re-fitted
  double after_train = 0.0, after_validate = 0.0;    ///< combined, with the effects of the verdict
  std::vector<ErrorRegion> where;                    ///< of the base re-fitted, on all records
  std::vector<JudgedCandidate> candidates;           ///< best first
  DiagnosisVerdict verdict;
  sim::DriveDescription base;  ///< the given model, re-fitted
  sim::DriveDescription best;  ///< with the effects of the verdict; the base where there are none
  RecordSet training, validation;
};

/// The sets, floors and re-fitted base that a diagnosis begins with. Throws Failure(bad_input) for records that cannot
/// be compared. Keeps references to the records.
Diagnosis prepare_sets(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                       const std::vector<const Record*>& validation, double window_s = kWindow_s);

/// A candidate on validation data, against the base's error there.
JudgedCandidate judge_candidate(const Candidate& candidate, const RecordSet& training, const RecordSet& validation,
                                const SetError& before);

/// Over windows of kWindow_s; where the machine proves rough, again over shorter ones, in which an error of force shows
/// before it adds up to a drift (`known_rough`: over these at once). Throws Failure(bad_input) for records that cannot
/// be compared. Keeps references to the records.
Diagnosis diagnose(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                   const std::vector<const Record*>& validation, const ShareDone& progress = {},
                   bool known_rough = false);

}  // namespace host
