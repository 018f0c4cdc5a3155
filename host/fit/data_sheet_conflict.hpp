// Contradictions between the data and the known values of a drive.
#pragma once

#include <string>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// One parameter whose known value the records contradict.
struct DataSheetConflict {
  std::string parameter;  ///< "inertia J_kg_m2"
  double known = 0.0;     ///< the held value or the mean of the prior
  double wanted = 0.0;    ///< the value that fits the records best
  std::string words;      ///< a sentence
};

/// Parameters of `fitted` that the fit moved two standard deviations from their prior, and held parameters that a free
/// fit changes by more than 10 % while it lowers the error by 5 %. `set`: training data.
std::vector<DataSheetConflict> data_sheet_conflicts(const sim::DriveDescription& fitted, const RecordSet& set);

}  // namespace host
