// Folders that belong to the user alone.
#pragma once

#include <string>

namespace host {

/// The folder that the environment variable names, else the one below the user's home (HOME, else the system's list of
/// users), made with rights for the user alone. /tmp is not used, because other users may occupy a name there. Throws
/// Failure(permission) if the folder belongs to another user, if others may write to it, or if there is no home.
std::string own_folder(const char* variable, const std::string& below_home);

}  // namespace host
