// The one function that writes outputs: files are either the old ones or the new ones, never half of each.
#pragma once

#include <string>
#include <string_view>

namespace host {

/// Writes `text` beside the file that `path` stands for (links are followed, rights are kept), fsyncs, renames. Throws
/// Failure naming the path and the system's reason: as output_target() does, permission, or bad_input (disk full).
void write_file_atomically(const std::string& path, std::string_view text);

/// Writes `text` on standard output and flushes it. Throws Failure(bad_input) where not all of it arrived.
void write_standard_output(std::string_view text);

/// Flushes standard output. Throws as write_standard_output() does, also for an earlier failure.
void finish_standard_output();

}  // namespace host
