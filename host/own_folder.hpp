// Folders that belong to the user alone.
#pragma once

#include <string>

namespace host {

/// The folder in the environment variable, else the one below the user's home (HOME, else the system's list of users);
/// created with rights for the user alone. /tmp is not used, because another user may have taken the name there. Throws
/// Failure(permission) if the folder belongs to another user, if others may write to it, or if there is no home.
std::string own_folder(const char* variable, const std::string& below_home);

}  // namespace host
