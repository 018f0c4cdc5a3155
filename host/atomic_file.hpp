// The only function that writes outputs: a file is either the old or the new one, never a mixture.
#pragma once

#include <string>
#include <string_view>

namespace host {

/// Writes `text` to a file beside the target of `path` (links are followed, rights are kept), fsyncs, renames. Throws
/// Failure naming the path and the system's reason: those of output_target(), permission, or bad_input (disk full).
void write_file_atomically(const std::string& path, std::string_view text);

/// Writes `text` on standard output and flushes it. Throws Failure(bad_input) if it could not be written completely.
void write_standard_output(std::string_view text);

/// Flushes standard output. Throws as write_standard_output() does, also for an earlier failure.
void finish_standard_output();

}  // namespace host
