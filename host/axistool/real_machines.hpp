// Results of diagnose on measured machines with known answers.
#pragma once

#include <string>

namespace axistool {

/// Diagnoses every machine of FOLDER/expected.json and prints the table; `json` as in other commands. Throws
/// Failure(bad_input) if the file or a record is missing.
void score_real_machines(const std::string& folder, const std::string& json);

}  // namespace axistool
