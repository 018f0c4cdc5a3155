// Reads the keys typed on the terminal while a command runs.
#pragma once

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <string>

namespace axistool {

/// During its lifetime, keys arrive without Enter and without echo. Has no effect if standard input is not a terminal,
/// or if this program is not in its foreground. Ctrl-C and Ctrl-Z remain signals.
class TypedKeys {
 public:
  TypedKeys() {
    if (::isatty(STDIN_FILENO) == 0 || ::tcgetpgrp(STDIN_FILENO) != ::getpgrp()) return;
    is_ours_ = ::tcgetattr(STDIN_FILENO, &before_) == 0;
    termios keys = before_;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    if (is_ours_) ::tcsetattr(STDIN_FILENO, TCSANOW, &keys);
  }
  ~TypedKeys() {
    if (is_ours_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  TypedKeys(const TypedKeys&) = delete;
  TypedKeys& operator=(const TypedKeys&) = delete;

  /// Keys since the last call; Enter is '\n'. Never waits.
  std::string take() const {
    std::string typed;
    pollfd input{STDIN_FILENO, POLLIN, 0};
    while (is_ours_ && ::poll(&input, 1, 0) > 0 && (input.revents & POLLIN) != 0) {
      std::array<char, 64> some{};
      const ssize_t count = ::read(STDIN_FILENO, some.data(), some.size());
      if (count <= 0) break;
      typed.append(some.data(), static_cast<std::size_t>(count));
    }
    return typed;
  }

 private:
  termios before_{};
  bool is_ours_ = false;
};

}  // namespace axistool
