// The computer's end of the emulated board's cable.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <stdexcept>

namespace target_test {

class CablePort {
 public:
  CablePort(const std::filesystem::path& to_board, const std::filesystem::path& from_board)
      : to_(open(to_board.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600)) {
    if (mkfifo(from_board.c_str(), 0600) == 0) from_ = open(from_board.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (to_ < 0 || from_ < 0) throw std::runtime_error("no cable");
  }
  CablePort(const CablePort&) = delete;
  CablePort& operator=(const CablePort&) = delete;
  ~CablePort() {
    close(to_);
    close(from_);
  }
  void send(std::byte byte) const {
    if (write(to_, &byte, 1) != 1) throw std::runtime_error("the cable takes nothing");
  }
  bool receive(std::byte& byte) const { return read(from_, &byte, 1) == 1; }

 private:
  int to_ = -1, from_ = -1;
};

}  // namespace target_test
