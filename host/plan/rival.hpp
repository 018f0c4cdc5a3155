// Rival explanations of the same records: fitted models that are compared over the same noise floors.
#pragma once

#include <string>
#include <vector>

#include "host/compare/comparison.hpp"
#include "host/diagnose/diagnosis.hpp"

namespace host {

/// One explanation: effects added to the model, with all parameters fitted.
struct Rival {
  std::vector<std::string> kinds;
  sim::DriveDescription model;
  double probability = 0.0;  ///< prior probability; the sum over all rivals is 1
};

/// "cogging", "backlash + input_delay"
std::string rival_name(const std::vector<std::string>& kinds);

/// Fits every explanation to the records, whether it is significant or not. All get the same probability. Throws
/// Failure(usage) for an effect that is unknown or cannot be added to this model, Failure(bad_input) for records that
/// cannot be compared. `known`: a fitted model of one of them. The common parameters start from that model, from the
/// best of the rivals, and from the given model, so that two similar rivals do not differ only because one fit was
/// stuck.
std::vector<Rival> fit_rivals(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                              const std::vector<std::vector<std::string>>& kinds, const ShareDone& progress = {},
                              const Rival* known = nullptr);

/// The candidates of a diagnosis that these records cannot tell apart, with their probabilities. Fitted to `records`,
/// which are all records of the diagnosis. Empty for another verdict.
std::vector<Rival> rivals_of(const Diagnosis& diagnosis, const std::vector<const Record*>& records);

/// The rivals that a plan separates: `kinds` fitted to `records` (all measured records), or, if `kinds` is empty, the
/// rivals that a diagnosis leaves. Throws Failure(answer_is_no) if a diagnosis leaves none, and what fit_rivals() and
/// diagnose() throw.
std::vector<Rival> rivals_for(const sim::DriveDescription& model, const Measurements& measured,
                              const std::vector<const Record*>& records,
                              const std::vector<std::vector<std::string>>& kinds, const ShareDone& progress = {});

/// Records prepared to compare rivals: each window has the largest noise floor of any rival. With noise floors of its
/// own, a model that amplifies errors could explain anything.
RecordSet common_ground(const std::vector<const Record*>& records, const std::vector<Rival>& rivals,
                        double window_s = kWindow_s);

/// A set with the records from `begin` to `end` - 1 only.
RecordSet part_of(const RecordSet& set, std::size_t begin, std::size_t end);

/// Sum over windows and channels of squared error over squared noise floor, weighted as in a fit. Each window of 0.1 s
/// counts as one observation, because its errors are correlated. If even good models are far above the noise floors,
/// the error is relative to the common error.
double chi_square(const sim::DriveDescription& model, const RecordSet& set);

/// Ratio of chi_square() to the square of SetError::robust.
double chi_scale(const RecordSet& set);

/// Mean chi_square() per observation, which is one channel of a window.
double chi_square_each(const sim::DriveDescription& model, const RecordSet& set);

/// The rival with its parameters fitted to a set, starting from their present values.
sim::DriveDescription refitted(const sim::DriveDescription& start, const RecordSet& set);

}  // namespace host
