// Folders that belong to the user alone.
#pragma once

#include <string>

namespace host {

/// The folder that the environment variable names, else the one below the user's home (HOME, else the system's list of
/// users), made with rights for the user alone. Nothing lies in /tmp, where others may take a name first. Throws
/// Failure(permission) where it belongs to another user or others may write it, and where there is no home.
std::string own_folder(const char* variable, const std::string& below_home);

}  // namespace host
