// Diagnoses measured machines with known answers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/diagnose/diagnosis.hpp"

namespace host {

/// An entry of FOLDER/expected.json.
struct RealMachine {
  std::string name;
  std::string model;                            ///< file
  std::vector<std::string> train, validate;     ///< files
  std::vector<std::string> accepted;            ///< faults of the log
  std::vector<std::vector<std::string>> right;  ///< right answers, each a set of kinds
  std::vector<std::string> must_not;            ///< kinds that the machine is known not to have
};

/// Throws Failure(bad_input) if the file is missing or has no object "machines".
std::vector<RealMachine> read_real_machines(const std::filesystem::path& folder);

struct RealAnswer {
  Diagnosis diagnosis;
  double seconds = 0.0;
  bool listed = false;                 ///< the verdict is a right answer, or a group that contains one
  std::vector<std::string> not_there;  ///< claimed effects that the machine is known not to have

  bool is_right() const { return listed && not_there.empty(); }
};

/// Throws Failure(bad_input) if a record is missing or bad.
RealAnswer ask(const RealMachine& machine, const ShareDone& progress = {});

/// Orders of the periodic effects that a diagnosis added.
std::vector<double> orders_of(const Diagnosis& diagnosis);

}  // namespace host
