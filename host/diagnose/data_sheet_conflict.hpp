// Where the data fight what is known of a drive.
#pragma once

#include <string>
#include <vector>

#include "host/compare/comparison.hpp"

namespace host {

/// One parameter that the records would have otherwise.
struct DataSheetConflict {
  std::string parameter;  ///< "inertia J_kg_m2"
  double known = 0.0;     ///< as held or believed
  double wanted = 0.0;    ///< by the records
  std::string words;      ///< a sentence
};

/// Believed parameters of `fitted` that ended two deviations off, and held ones that a fit without constraint would
/// move by more than a tenth while it lowers the error by a twentieth. `set` trains.
std::vector<DataSheetConflict> data_sheet_conflicts(const sim::DriveDescription& fitted, const RecordSet& set);

}  // namespace host
