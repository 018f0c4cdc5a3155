#include "host/device/capture_wish.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>

#include "host/exit_codes.hpp"
#include "host/own_folder.hpp"

namespace host {

namespace {

/// The file of a board; -1 if it cannot be opened.
int open_file(const std::string& board, int flags) {
  std::string name = board;
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '-');
  try {
    const std::string path = own_folder("XDG_RUNTIME_DIR", ".local/state/axis") + "/axistool-capture-" + name;
    return ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC | flags, 0600);
  } catch (const Failure&) {
    return -1;
  }
}

}  // namespace

CaptureWish::CaptureWish(const std::string& board) : file_(open_file(board, O_CREAT)) {
  if (file_ >= 0) ::flock(file_, LOCK_SH | LOCK_NB);
}

CaptureWish::~CaptureWish() {
  if (file_ >= 0) ::close(file_);
}

bool is_capture_wished(const std::string& board) {
  const int file = open_file(board, 0);
  if (file < 0) return false;
  const bool is_locked = ::flock(file, LOCK_EX | LOCK_NB) != 0;
  ::close(file);
  return is_locked;
}

}  // namespace host
