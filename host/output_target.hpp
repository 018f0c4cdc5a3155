// Checks whether an output may be written, before any computation and again when it is written.
#pragma once

#include <string>

namespace host {

/// Protects a file: from now on no output of this process replaces it, under any name or link. Ignored if there is no
/// such file.
void protect_input(const std::string& path);

/// The target of `path` after following links, even if it does not exist yet. Throws Failure: usage if it is an input
/// or no regular file; bad_input if its folder is missing; permission if folder or file may not be written.
std::string output_target(const std::string& path);

/// The same check for a folder, which will be created with its parents if it is missing.
void require_output_folder(const std::string& folder);

}  // namespace host
