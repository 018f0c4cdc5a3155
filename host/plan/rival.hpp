// Rival explanations of the same records: fitted models, compared with the same noise floors.
#pragma once

#include <string>
#include <vector>

#include "host/compare/comparison.hpp"
#include "host/diagnose/diagnosis.hpp"

namespace host {

/// One explanation: effects added to the model, with everything fitted.
struct Rival {
  std::vector<std::string> kinds;
  sim::DriveDescription model;
  double probability = 0.0;  ///< prior probability; those of all rivals together are 1
};

/// "cogging", "backlash + input_delay"
std::string rival_name(const std::vector<std::string>& kinds);

/// Fits every explanation to the records, significant or not. All are equally probable. Throws Failure(usage) for an
/// effect that is unknown or cannot be added to this model, Failure(bad_input) for records that cannot be compared.
/// `known`: a fitted model of one of them. Common parameters start from there, from the best of the rivals, and from
/// the given model, so that two similar rivals do not differ because one fit was stuck.
std::vector<Rival> fit_rivals(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                              const std::vector<std::vector<std::string>>& kinds, const ShareDone& progress = {},
                              const Rival* known = nullptr);

/// The undecided alternatives of a diagnosis, with their probabilities: candidates that these records do not separate.
/// Fitted to `records`, all of its records. Empty for another verdict.
std::vector<Rival> rivals_of(const Diagnosis& diagnosis, const std::vector<const Record*>& records);

/// The rivals that a plan separates: `kinds` fitted to `records`, all that were measured; without `kinds`, those that a
/// diagnosis leaves.
/// Throws Failure(answer_is_no) where a diagnosis leaves none, and what fit_rivals() and diagnose() throw.
std::vector<Rival> rivals_for(const sim::DriveDescription& model, const Measurements& measured,
                              const std::vector<const Record*>& records,
                              const std::vector<std::vector<std::string>>& kinds, const ShareDone& progress = {});

/// Records prepared to compare rivals: each window has the largest floor of any rival, since with floors of its own a
/// model that amplifies errors could explain anything.
RecordSet common_ground(const std::vector<const Record*>& records, const std::vector<Rival>& rivals,
                        double window_s = kWindow_s);

/// A set that holds the records from `begin` to before `end` only.
RecordSet part_of(const RecordSet& set, std::size_t begin, std::size_t end);

/// Sum over windows and channels of squared error over squared floor, with a fit's weights: each window of 0.1 s counts
/// as one observation, since its errors are correlated. If even good models are far above the floors, relative to the
/// common error.
double chi_square(const sim::DriveDescription& model, const RecordSet& set);

/// chi_square() over its part of SetError::robust squared.
double chi_scale(const RecordSet& set);

/// Mean chi_square() of one observation, a window's channel.
double chi_square_each(const sim::DriveDescription& model, const RecordSet& set);

/// The rival's parameters fitted to a set, from their present values.
sim::DriveDescription refitted(const sim::DriveDescription& start, const RecordSet& set);

}  // namespace host
