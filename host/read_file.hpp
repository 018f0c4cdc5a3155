// Whole files in.
#pragma once

#include <string>

namespace host {

/// The bytes of a file. Throws Failure(bad_input) naming the path and the system's reason.
std::string read_file(const std::string& path);

}  // namespace host
