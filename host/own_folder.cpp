#include "host/own_folder.hpp"

#include <fmt/format.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "host/exit_codes.hpp"

namespace host {

namespace {

std::string variable_or(const char* name, std::string otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr && *value == '/' ? std::string(value) : std::move(otherwise);
}

std::string home() {
  const passwd* user = ::getpwuid(::getuid());
  return variable_or("HOME", user != nullptr && user->pw_dir != nullptr ? user->pw_dir : "");
}

[[noreturn]] void refuse(const std::string& folder, const std::string& why, const char* variable) {
  throw Failure(ExitCode::permission, fmt::format("{}: {}; set {} to a folder of your own", folder, why, variable));
}

void make(const std::filesystem::path& folder) {
  if (folder.has_parent_path() && !std::filesystem::exists(folder.parent_path())) make(folder.parent_path());
  ::mkdir(folder.c_str(), 0700);
}

}  // namespace

std::string own_folder(const char* variable, const std::string& below_home) {
  std::string folder = variable_or(variable, "");
  if (folder.empty()) {
    const std::string from = home();
    if (from.empty() || from == "/") refuse("no home folder", "there is no place for your files", variable);
    folder = from + "/" + below_home;
    make(folder);
  }
  struct stat found {};
  if (::stat(folder.c_str(), &found) != 0) refuse(folder, std::strerror(errno), variable);
  if (!S_ISDIR(found.st_mode)) refuse(folder, "no folder", variable);
  if (found.st_uid != ::getuid()) refuse(folder, "it belongs to another user", variable);
  const bool is_shared =
      (found.st_mode & S_IWGRP) != 0 && found.st_gid != ::getgid();  // the user's own group contains nobody else
  if ((found.st_mode & S_IWOTH) != 0 || is_shared) refuse(folder, "others may write in it", variable);
  return folder;
}

}  // namespace host
