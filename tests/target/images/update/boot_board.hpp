// QEMU's mps2-an386 with boot code: its code memory, which programs may write, is the flash.
#pragma once

#include <algorithm>
#include <cstring>

#include "hal/flash.hpp"
#include "hal/mps2/cmsdk.hpp"

namespace firmware::boards {

/// The sectors of the axis board's images in 16 KB after address 0, with the rules of flash.
class CodeMemoryFlash {
 public:
  static constexpr std::uintptr_t kFirstAddress = 0x4000;

  std::size_t sector_count() const { return 3; }
  std::size_t sector_size() const { return 112 * 1024; }
  std::size_t program_size() const { return 4; }
  std::span<const std::byte> view(std::size_t sector) const { return {at(sector), sector_size()}; }

  hal::FlashResult read(std::size_t sector, std::size_t offset, std::span<std::byte> out) {
    std::copy_n(at(sector) + offset, out.size(), out.begin());
    return hal::FlashResult::ok;
  }
  hal::FlashResult program(std::size_t sector, std::size_t offset, std::span<const std::byte> in) {
    std::byte* const cells = at(sector) + offset;
    for (std::size_t i = 0; i < in.size(); ++i) {
      if ((in[i] & ~cells[i]) != std::byte{0}) return hal::FlashResult::not_erased;
      cells[i] = in[i];
    }
    return hal::FlashResult::ok;
  }
  hal::FlashResult erase(std::size_t sector) {
    std::fill_n(at(sector), sector_size(), std::byte{0xFF});
    return hal::FlashResult::ok;
  }

 private:
  static std::byte* at(std::size_t sector) {
    constexpr std::uintptr_t kAddresses[] = {kFirstAddress, 0x20000, 0x40000};
    return reinterpret_cast<std::byte*>(kAddresses[sector]);
  }
};
static_assert(hal::Flash<CodeMemoryFlash>);

class BootBoard {
 public:
  static constexpr std::uintptr_t kProgram = CodeMemoryFlash::kFirstAddress;

  CodeMemoryFlash& image_flash() { return flash_; }
  void watch_trial() {
    constexpr std::uint32_t kHalf_s = 12'500'000;  // of the 25 MHz clock; resets after twice that
    hal::mps2::Watchdog().start(kHalf_s);
  }

 private:
  CodeMemoryFlash flash_;
};

}  // namespace firmware::boards
