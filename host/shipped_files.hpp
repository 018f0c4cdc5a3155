// Files that come with the program: scenarios, the demonstration's record.
#pragma once

#include <string>
#include <vector>

namespace host {

/// `name` below the folder that belongs to this program: AXISTOOL_SHARE where it is set, else ../share/axistool beside
/// the program's own folder. Need not exist.
std::string shipped_file(const std::string& name);

/// Names of the shipped scenarios, without .toml, sorted.
std::vector<std::string> shipped_scenarios();

/// A file of this name, else the shipped scenario of this name, with or without .toml. Throws Failure(usage) listing
/// the shipped ones.
std::string scenario_file(const std::string& name);

/// Names, without .toml, of the machines for `axistool commission --sim`, sorted; the second, for a line of help.
std::vector<std::string> shipped_machines();
std::string shipped_machines_text();

/// A model file of this name, else the shipped machine of this name. Throws Failure(usage) listing the shipped ones.
std::string machine_file(const std::string& name);

}  // namespace host
