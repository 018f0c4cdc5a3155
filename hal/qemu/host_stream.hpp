// A byte stream between the emulated processor and a program on the emulator's computer. QEMU's serial ports receive
// one byte at a time, and each byte waits for the emulator's other work; files transfer any number at once.
#pragma once

#include <array>
#include <atomic>
#include <string_view>

#include "hal/qemu/semihosting.hpp"
#include "hal/serial_port.hpp"

namespace hal::qemu {

class HostStream {
 public:
  /// `incoming`: a file to which the other program appends; its present content is ignored. `outgoing`: a FIFO. While
  /// that is full the emulated processor and its time stop. Names are relative to the emulator's working directory.
  /// False if one cannot be opened.
  bool open(std::string_view incoming, std::string_view outgoing) {
    return incoming_.open(incoming.data(), incoming.size(), HostFile::Mode::read_binary) && incoming_.skip_to_end() &&
           outgoing_.open(outgoing.data(), outgoing.size(), HostFile::Mode::write_binary);
  }

  /// Sent with flush(), at the latest when the buffer is full.
  void send(std::byte byte) {
    leaving_[leaving_count_++] = byte;
    if (leaving_count_ == leaving_.size()) flush();
  }
  void flush() {
    outgoing_.write(std::span(leaving_).first(leaving_count_));
    leaving_count_ = 0;
  }

  /// For an interrupt: reads newly arrived bytes once all earlier ones have been received. If there are none it changes
  /// nothing, because it may run between the two loads of receive(), which must not find a new place with an old count.
  void fetch() {
    if (next_ != arrived_count_) return;
    const std::size_t count = incoming_.read_some(arrived_);
    if (count == 0) return;
    next_ = 0;
    arrived_count_ = count;
  }
  bool receive(std::byte& byte) {
    if (next_ == arrived_count_) return false;
    byte = arrived_[next_];
    std::atomic_signal_fence(std::memory_order_seq_cst);  // from then on fetch() may overwrite the byte
    next_ = next_ + 1;
    return true;
  }

 private:
  HostFile incoming_, outgoing_;
  std::array<std::byte, 256> leaving_{};
  std::array<std::byte, 1024> arrived_{};
  std::size_t leaving_count_ = 0;
  volatile std::size_t arrived_count_ = 0, next_ = 0;
};

static_assert(SerialPort<HostStream>);

}  // namespace hal::qemu
