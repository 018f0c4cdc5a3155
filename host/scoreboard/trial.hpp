// Trials of the diagnosis on records with a known truth: whole cases and pieces of them, which resemble a new user's
// first records.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "host/record/record.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// Hidden effects of a case.
struct Truth {
  std::vector<std::string> effects;  ///< kinds; empty if nothing is hidden
  bool alien = false;                ///< the hidden effect is in no catalogue
};

/// Folders at any depth that contain a case (model.toml, train-*.csv, validate.csv, truth.json), sorted by name. Throws
/// Failure(bad_input) if there is none.
std::vector<std::filesystem::path> find_cases(const std::string& folder);

/// Throws Failure(bad_input) for a file without a list "effects".
Truth read_truth(const std::filesystem::path& case_folder);

/// Part of a record file, seconds after its start.
struct Piece {
  std::string path;
  double from_s = 0.0, to_s = HUGE_VAL;
};

struct Trial {
  std::string name;
  std::string group;  ///< row of the table in which it is counted: "one record", "2 s"
  std::filesystem::path folder;
  std::vector<Piece> train, validate;  ///< if `validate` is empty, a part of the training data is held back
};

/// All training records and the validation record.
Trial whole_case(const std::filesystem::path& folder, const std::string& name);

/// Each training record alone, each pair of them, and the first `lengths_s` of each. Without validation records.
std::vector<Trial> pieces_of_case(const std::filesystem::path& folder, const std::string& name,
                                  const std::vector<double>& lengths_s, bool pairs);

/// Throws Failure(bad_input) for a bad file, or a piece outside the record.
Record read_piece(const Piece& piece, const sim::DataSheet& data);

}  // namespace host
