#include "host/commission/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "host/exit_codes.hpp"
#include "host/output_target.hpp"

namespace host {

FolderLock::FolderLock(const std::string& folder) {
  require_output_folder(folder);
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (fault)
    throw Failure(ExitCode::permission, fmt::format("{}: cannot make this folder: {}", folder, fault.message()));
  descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw Failure(ExitCode::refused,
                folder + ": another commissioning uses this folder; wait for its end, or give another -o");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace host
