// What a diagnosis begins with: which windows of the records train, which judge, and the base fitted to the first.
#pragma once

#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

struct PreparedSets {
  double window_s = kWindow_s;
  Measure measure = Measure::motion;
  bool held_back = false;      ///< no validation record was given: blocks of the training data were kept back
  bool moves_enough = false;   ///< otherwise the base is the model as it was given
  sim::DriveDescription base;  ///< the given model, re-fitted
  RecordSet training, validation;
};

/// The sets, floors and re-fitted base that a diagnosis begins with. Throws Failure(bad_input) for records that cannot
/// be compared. Keeps references to the records.
PreparedSets prepare_sets(const sim::DriveDescription& model, const std::vector<const Record*>& training,
                          const std::vector<const Record*>& validation, double window_s = kWindow_s,
                          Measure measure = Measure::motion);

}  // namespace host
