// Memory at an address of the chip, which programs read directly and not through a register.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

namespace parts {

/// Initially zero. Begins and ends at a page boundary; the test itself must not use these addresses.
class MemoryAt {
 public:
  MemoryAt(std::uintptr_t address, std::size_t size)
      : memory_(mmap(reinterpret_cast<void*>(address), size, PROT_READ | PROT_WRITE,
                     MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED_NOREPLACE, -1, 0)),
        size_(size) {
    if (memory_ == MAP_FAILED) throw std::runtime_error("no memory at one of the chip's addresses");
  }
  MemoryAt(const MemoryAt&) = delete;
  MemoryAt& operator=(const MemoryAt&) = delete;
  ~MemoryAt() { munmap(memory_, size_); }

  std::span<std::byte> bytes() const { return {static_cast<std::byte*>(memory_), size_}; }

 private:
  void* memory_;
  std::size_t size_;
};

}  // namespace parts
