// Requests of the program to the emulator: Arm semihosting (Semihosting for AArch32 and AArch64, release 2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace hal::qemu {

enum class Semihosting : std::uint32_t {
  open = 0x01,
  write_text = 0x04,
  write = 0x05,
  read = 0x06,
  seek = 0x0A,
  file_length = 0x0C,
  command_line = 0x15,
  exit_extended = 0x20,
};

inline std::int32_t semihosting(Semihosting request, const void* argument) {
  register std::uint32_t r0 asm("r0") = static_cast<std::uint32_t>(request);
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return static_cast<std::int32_t>(r0);
}

inline void print(const char* text) { semihosting(Semihosting::write_text, text); }

[[noreturn]] inline void exit_emulator(std::uint32_t status) {
  constexpr std::uint32_t kApplicationExit = 0x20026;
  const std::uint32_t block[2] = {kApplicationExit, status};
  semihosting(Semihosting::exit_extended, block);
  for (;;) asm volatile("" ::: "memory");
}

/// The text after `arg=` in -semihosting-config, cut to fit; false if there is none.
inline bool command_line(std::span<char> text) {
  struct {
    char* buffer;
    std::uint32_t length;
  } block{text.data(), static_cast<std::uint32_t>(text.size())};
  return semihosting(Semihosting::command_line, &block) == 0;
}

/// A file or FIFO of the machine that runs the emulator. The emulated processor stands still during every call.
class HostFile {
 public:
  enum class Mode : std::uint32_t { read_binary = 1, write_binary = 5 };

  bool open(const char* path, std::size_t path_length, Mode mode) {
    const struct {
      const char* path;
      std::uint32_t mode;
      std::uint32_t length;
    } block{path, static_cast<std::uint32_t>(mode), static_cast<std::uint32_t>(path_length)};
    handle_ = semihosting(Semihosting::open, &block);
    return handle_ >= 0;
  }

  /// Waits for all bytes; false at the end of the file or on an error.
  bool read(std::span<std::byte> bytes) const { return transfer(Semihosting::read, bytes.data(), bytes.size()); }
  /// Reads the available bytes; returns their number.
  std::size_t read_some(std::span<std::byte> bytes) const {
    const std::size_t left = ask(Semihosting::read, bytes.data(), bytes.size());
    return left < bytes.size() ? bytes.size() - left : 0;
  }
  bool write(std::span<const std::byte> bytes) const {
    return transfer(Semihosting::write, bytes.data(), bytes.size());
  }

  /// Only for a file, not for a FIFO.
  bool skip_to_end() const {
    const std::int32_t length = semihosting(Semihosting::file_length, &handle_);
    const std::int32_t block[2] = {handle_, length};
    return length >= 0 && semihosting(Semihosting::seek, block) >= 0;
  }

 private:
  /// Bytes that were not transferred.
  std::size_t ask(Semihosting request, const std::byte* data, std::size_t size) const {
    const struct {
      std::int32_t handle;
      const std::byte* data;
      std::uint32_t length;
    } block{handle_, data, static_cast<std::uint32_t>(size)};
    return static_cast<std::size_t>(semihosting(request, &block));
  }

  bool transfer(Semihosting request, const std::byte* data, std::size_t size) const {
    while (size != 0) {
      const std::size_t left = ask(request, data, size);
      if (left >= size) return false;
      data += size - left;
      size = left;
    }
    return true;
  }

  std::int32_t handle_ = -1;
};

}  // namespace hal::qemu
