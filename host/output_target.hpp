// Checks where an output may be written: before any computation, and again when it is written.
#pragma once

#include <string>

namespace host {

/// Protects a file: no further output of this process replaces it, under any name or link. A name without a file is
/// ignored.
void protect_input(const std::string& path);

/// The file that `path` stands for, links followed, and also where the last one leads to no file yet. Throws Failure:
/// usage where it is an input or no regular file; bad_input where its folder is missing; permission where folder or
/// file may not be written.
std::string output_target(const std::string& path);

/// The same for a folder that will be made where it is missing, with all above it.
void require_output_folder(const std::string& folder);

}  // namespace host
