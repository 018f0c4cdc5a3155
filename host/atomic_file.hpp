// Files that are either the old ones or the new ones, never half of each.
#pragma once

#include <string>
#include <string_view>

namespace host {

/// Writes `text` beside `path`, fsyncs, renames. Throws Failure(bad_input) naming the path and the system's reason.
void write_file_atomically(const std::string& path, std::string_view text);

}  // namespace host
