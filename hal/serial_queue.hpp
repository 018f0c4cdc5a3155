// Buffer for a serial line that is slower than the program, so that the program never waits.
#pragma once

#include <array>
#include <cstdint>

#include "hal/serial_port.hpp"

namespace hal {

/// `send` queues and returns at once; bytes that do not fit are dropped and counted. `poll` passes on the bytes that
/// the line accepts: call it at least once per character time. Call both from the same context.
template <SerialLine Line, std::size_t size>
class SerialQueue {
 public:
  explicit constexpr SerialQueue(Line& line) : line_(line) {}

  void send(std::byte byte) {
    if (count_ == size) {
      ++lost_;
      return;
    }
    waiting_[(first_ + count_) % size] = byte;
    ++count_;
  }

  bool receive(std::byte& byte) { return line_.receive(byte); }

  void poll() {
    while (count_ > 0 && line_.offer(waiting_[first_])) {
      first_ = (first_ + 1) % size;
      --count_;
    }
  }

  bool is_empty() const { return count_ == 0; }
  std::uint32_t lost() const { return lost_; }

 private:
  Line& line_;
  std::array<std::byte, size> waiting_{};
  std::size_t first_ = 0, count_ = 0;
  std::uint32_t lost_ = 0;
};

}  // namespace hal
