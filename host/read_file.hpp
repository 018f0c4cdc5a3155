// Reads whole files.
#pragma once

#include <string>

#include "host/input_limits.hpp"

namespace host {

/// The bytes of a file, read up to the limit at most. Throws Failure(bad_input) naming the path and the system's
/// reason, or the exceeded limit.
std::string read_file(const std::string& path, const ByteLimit& limit);

/// Text of a document.
std::string read_file(const std::string& path);

}  // namespace host
