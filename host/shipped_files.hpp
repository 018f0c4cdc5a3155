// Files shipped with the program: scenarios, machines, the record of the demonstration.
#pragma once

#include <string>
#include <vector>

namespace host {

/// Path of `name` in the folder of shipped files: AXISTOOL_SHARE if it is set, else ../share/axistool, relative to the
/// program's folder. The file need not exist.
std::string shipped_file(const std::string& name);

/// Names of the shipped scenarios, without .toml, sorted.
std::vector<std::string> shipped_scenarios();

/// A file of this name, else the shipped scenario of this name, with or without .toml. Throws Failure(usage) with the
/// list of shipped scenarios.
std::string scenario_file(const std::string& name);

/// Names, without .toml, of the machines for `axistool commission --sim`, sorted; the second function gives them as one
/// line for help texts.
std::vector<std::string> shipped_machines();
std::string shipped_machines_text();

/// A model file of this name, else the shipped machine of this name. Throws Failure(usage) with the list of shipped
/// machines.
std::string machine_file(const std::string& name);

}  // namespace host
