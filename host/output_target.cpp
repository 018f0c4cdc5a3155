#include "host/output_target.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>
#include <utility>

#include "host/exit_codes.hpp"

namespace host {

namespace {

namespace fs = std::filesystem;

/// Device and inode of a file: the same under every name.
using FileIdentity = std::pair<dev_t, ino_t>;

std::set<FileIdentity>& protected_inputs() {
  static std::set<FileIdentity> inputs;
  return inputs;
}

template <typename... Args>
[[noreturn]] void fail(ExitCode code, fmt::format_string<Args...> format, Args&&... args) {
  throw Failure(code, fmt::format(format, std::forward<Args>(args)...));
}

/// The end of a chain of symbolic links; it need not exist.
fs::path end_of_links(const std::string& name) {
  fs::path path(name);
  constexpr int kMostLinks = 40;  // as Linux follows them
  for (int k = 0; k < kMostLinks; ++k) {
    std::error_code fault;
    if (!fs::is_symlink(fs::symlink_status(path, fault))) return path;
    const fs::path next = fs::read_symlink(path, fault);
    if (fault) fail(ExitCode::permission, "{}: cannot follow the link: {}", name, fault.message());
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  fail(ExitCode::usage, "{}: the link refers to itself; name another file", name);
}

void require_rights(const fs::path& path, int rights, const std::string& name, const char* what) {
  if (::access(path.c_str(), rights) == 0) return;
  fail(ExitCode::permission, "{}: {} may not be written: {}; name another place, or change its rights", name, what,
       std::strerror(errno));
}

void require_writable_folder(const fs::path& folder, const std::string& name) {
  struct stat found {};
  if (::stat(folder.c_str(), &found) != 0)
    fail(ExitCode::bad_input, "{}: folder {} does not exist ({}); make it first, or name another", name,
         folder.string(), std::strerror(errno));
  if (!S_ISDIR(found.st_mode))
    fail(ExitCode::bad_input, "{}: {} is not a folder; name another place", name, folder.string());
  require_rights(folder, W_OK | X_OK, name, "its folder");
}

}  // namespace

void protect_input(const std::string& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) == 0 && S_ISREG(found.st_mode))
    protected_inputs().emplace(found.st_dev, found.st_ino);
}

std::string output_target(const std::string& path) {
  if (path.empty()) fail(ExitCode::usage, "the name of an output file is empty; give one");
  const fs::path target = end_of_links(path);
  struct stat found {};
  if (::stat(target.c_str(), &found) == 0) {
    if (S_ISDIR(found.st_mode)) fail(ExitCode::usage, "{}: this is a folder; name a file", path);
    if (!S_ISREG(found.st_mode))
      fail(ExitCode::usage, "{}: not a regular file, and outputs replace files as a whole; name a file", path);
    if (protected_inputs().contains({found.st_dev, found.st_ino}))
      fail(ExitCode::usage, "{}: this is an input of the command and is never overwritten; name another output", path);
    require_rights(target, W_OK, path, "the file");
  } else if (errno != ENOENT && errno != ENOTDIR) {
    fail(errno == EACCES ? ExitCode::permission : ExitCode::bad_input, "{}: cannot be written: {}; name another file",
         path, std::strerror(errno));
  }
  if (!target.has_filename()) fail(ExitCode::usage, "{}: this names a folder; name a file", path);
  require_writable_folder(target.has_parent_path() ? target.parent_path() : fs::path("."), path);
  return target.string();
}

void require_output_folder(const std::string& folder) {
  if (folder.empty()) fail(ExitCode::usage, "the name of an output folder is empty; give one");
  fs::path there = fs::absolute(folder);
  std::error_code fault;
  while (!fs::exists(there, fault) && there.has_relative_path()) there = there.parent_path();
  require_writable_folder(there, folder);
}

}  // namespace host
