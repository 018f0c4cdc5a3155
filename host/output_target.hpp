// Checks where an output may be written: before any computation, and again when it is written.
#pragma once

#include <string>

namespace host {

/// From now on no output of this process takes the place of this file, whatever name or link leads to it. A name that
/// leads to no file is ignored.
void protect_input(const std::string& path);

/// The file that `path` stands for, links followed, and also where the last one leads to no file yet. Throws Failure:
/// usage where it is an input or no regular file; bad_input where its folder is missing; permission where folder or
/// file may not be written.
std::string output_target(const std::string& path);

/// The same for a folder that will be made where it is missing, with all above it.
void require_output_folder(const std::string& folder);

}  // namespace host
