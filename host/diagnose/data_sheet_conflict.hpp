// Contradictions between the data and the known values of a drive.
#pragma once

#include <string>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// One parameter whose known value the records contradict.
struct DataSheetConflict {
  std::string parameter;  ///< "inertia J_kg_m2"
  double known = 0.0;     ///< as held, or as the prior gives it
  double wanted = 0.0;    ///< by the records
  std::string words;      ///< a sentence
};

/// Parameters of `fitted` that a fit moved two standard deviations from their prior, and held ones that a free fit
/// changes by more than 10 % while it lowers the error by 5 %. `set`: training data.
std::vector<DataSheetConflict> data_sheet_conflicts(const sim::DriveDescription& fitted, const RecordSet& set);

}  // namespace host
