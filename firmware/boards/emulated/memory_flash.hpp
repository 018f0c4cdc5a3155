// Flash in RAM that start-up does not initialise: it survives a reset, as flash does, but not the emulator's end.
#pragma once

#include <algorithm>
#include <array>

#include "hal/flash.hpp"

namespace firmware::boards {

template <std::size_t size>
class MemoryFlashOf {
 public:
  static constexpr std::size_t kSectors = 4, kSectorSize = size, kProgramSize = 4;

  /// Contents of the memory; an object of static storage in .noinit.
  struct Cells {
    std::uint32_t magic;
    std::array<std::array<std::byte, kSectorSize>, kSectors> sectors;
  };

  /// Initially erased, unless the memory already contains such a flash.
  explicit MemoryFlashOf(Cells& cells) : cells_(cells) {
    constexpr std::uint32_t kMagic = 0x464C5348;
    if (cells_.magic == kMagic) return;
    for (std::size_t sector = 0; sector < kSectors; ++sector) erase(sector);
    cells_.magic = kMagic;
  }

  std::size_t sector_count() const { return kSectors; }
  std::size_t sector_size() const { return kSectorSize; }
  std::size_t program_size() const { return kProgramSize; }

  std::span<const std::byte> view(std::size_t sector) const { return cells_.sectors[sector]; }

  hal::FlashResult read(std::size_t sector, std::size_t offset, std::span<std::byte> out) {
    if (!contains(sector, offset, out.size())) return hal::FlashResult::out_of_range;
    std::copy_n(cells_.sectors[sector].begin() + offset, out.size(), out.begin());
    return hal::FlashResult::ok;
  }

  hal::FlashResult program(std::size_t sector, std::size_t offset, std::span<const std::byte> in) {
    if (!contains(sector, offset, in.size())) return hal::FlashResult::out_of_range;
    if (offset % kProgramSize != 0 || in.size() % kProgramSize != 0) return hal::FlashResult::misaligned;
    for (std::size_t i = 0; i < in.size(); ++i) {
      std::byte& cell = cells_.sectors[sector][offset + i];
      if ((in[i] & ~cell) != std::byte{0}) return hal::FlashResult::not_erased;
      cell = in[i];
    }
    return hal::FlashResult::ok;
  }

  hal::FlashResult erase(std::size_t sector) {
    if (sector >= kSectors) return hal::FlashResult::out_of_range;
    cells_.sectors[sector].fill(std::byte{0xFF});
    return hal::FlashResult::ok;
  }

 private:
  static bool contains(std::size_t sector, std::size_t offset, std::size_t bytes) {
    return sector < kSectors && offset <= kSectorSize && bytes <= kSectorSize - offset;
  }

  Cells& cells_;
};
using MemoryFlash = MemoryFlashOf<4096>;
static_assert(hal::Flash<MemoryFlash>);

}  // namespace firmware::boards
