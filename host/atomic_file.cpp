#include "host/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "host/exit_codes.hpp"

namespace host {

namespace {

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw Failure(ExitCode::bad_input, fmt::format("{}: cannot {}: {}; check the folder's rights and free space", path,
                                                 what, std::strerror(errno)));
}

void write_all(int file, std::string_view text, const std::string& path) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, "write");
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// Removes the temporary file when writing ends by an exception.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string path) : path_(std::move(path)) {
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor_ < 0) fail(path_, "create");
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!renamed_) ::unlink(path_.c_str());
  }

  void write_and_sync(std::string_view text) {
    write_all(descriptor_, text, path_);
    if (::fsync(descriptor_) != 0) fail(path_, "flush");
  }

  void rename_to(const std::string& destination) {
    if (::rename(path_.c_str(), destination.c_str()) != 0) fail(destination, "replace");
    renamed_ = true;
  }

 private:
  std::string path_;
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
  TemporaryFile beside(fmt::format("{}.{}.partial", path, ::getpid()));
  beside.write_and_sync(text);
  beside.rename_to(path);
  sync_folder_of(path);
}

}  // namespace host
