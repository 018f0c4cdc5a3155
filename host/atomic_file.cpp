#include "host/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "host/exit_codes.hpp"
#include "host/output_target.hpp"

namespace host {

namespace {

[[noreturn]] void fail(const std::string& path, const char* what) {
  const bool no_right = errno == EACCES || errno == EPERM || errno == EROFS;
  throw Failure(
      no_right ? ExitCode::permission : ExitCode::bad_input,
      fmt::format("{}: cannot {}: {}; check the folder's rights and free space", path, what, std::strerror(errno)));
}

void write_all(int file, std::string_view text, const std::string& path) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, "write");
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

constexpr std::string_view kMark = ".axistool-", kEnding = ".partial";

/// Removes partial files of killed programs from the folder. A file that is still being written is locked by its
/// writer.
void remove_abandoned(const std::filesystem::path& folder) {
  std::error_code fault;
  for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, fault)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kMark) || !name.ends_with(kEnding)) continue;
    const auto writer = static_cast<pid_t>(std::strtol(name.c_str() + kMark.size(), nullptr, 10));
    if (writer <= 0 || ::kill(writer, 0) == 0 || errno != ESRCH) continue;
    const int file = ::open(entry.path().c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(entry.path().c_str());
    ::close(file);
  }
}

/// A new file in the folder of `destination`, with the rights of `destination` if that exists. Removed if writing ends
/// by an exception. Messages name the output as the user did.
class TemporaryFile {
 public:
  TemporaryFile(std::string destination, std::string name)
      : destination_(std::move(destination)), name_(std::move(name)) {
    const std::filesystem::path folder = std::filesystem::path(destination_).parent_path();
    remove_abandoned(folder);
    for (int number = 0; descriptor_ < 0; ++number) {
      path_ = (folder / fmt::format("{}{}-{}{}", kMark, ::getpid(), number, kEnding)).string();
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
      if (descriptor_ < 0 && errno != EEXIST) fail(name_, "create a file beside it");
    }
    ::flock(descriptor_, LOCK_EX | LOCK_NB);
    struct stat old {};
    if (::stat(destination_.c_str(), &old) == 0) ::fchmod(descriptor_, old.st_mode & 0777);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!renamed_) ::unlink(path_.c_str());
  }

  void write_and_sync(std::string_view text) {
    write_all(descriptor_, text, name_);
    if (::fsync(descriptor_) != 0) fail(name_, "flush");
  }

  void take_the_place() {
    if (::rename(path_.c_str(), destination_.c_str()) != 0) fail(name_, "replace");
    renamed_ = true;
  }

 private:
  std::string destination_, name_, path_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

void sync_folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void write_file_atomically(const std::string& path, std::string_view text) {
  const std::string target = output_target(path);
  TemporaryFile beside(target, path);
  beside.write_and_sync(text);
  beside.take_the_place();
  sync_folder_of(target);
}

void write_standard_output(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  finish_standard_output();
}

void finish_standard_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) fail("standard output", "write");
}

}  // namespace host
