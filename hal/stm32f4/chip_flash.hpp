// The chip's flash: sectors for images of the program, and for parameters and fault log. RM0090, sections 3.6 and 3.9.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>

#include "hal/flash.hpp"
#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

/// Parameters and fault log: sectors 8 to 11 of the STM32F405RG, 128 KB each (table 5).
struct ParameterSectors {
  static constexpr std::uintptr_t kFirstAddress = 0x08080000;
  static constexpr std::size_t kCount = 4, kSize = 128 * 1024;
  static constexpr std::size_t offset(std::size_t sector) { return sector * kSize; }
  static constexpr std::uint32_t first_of_chip(std::size_t sector) { return 8 + static_cast<std::uint32_t>(sector); }
  static constexpr std::uint32_t count_of_chip(std::size_t) { return 1; }
};

/// The place where programs run, sectors 1 to 4 of 16, 16, 16 and 64 KB, and two slots that keep images: as many bytes
/// of sectors 5 and 6.
struct ImageSectors {
  static constexpr std::uintptr_t kFirstAddress = 0x08004000;
  static constexpr std::size_t kCount = 3, kSize = 112 * 1024;
  static constexpr std::size_t offset(std::size_t sector) {
    return sector == 0 ? 0 : kSize + (sector - 1) * 128 * 1024;
  }
  static constexpr std::uint32_t first_of_chip(std::size_t sector) {
    return sector == 0 ? 1 : 4 + static_cast<std::uint32_t>(sector);
  }
  static constexpr std::uint32_t count_of_chip(std::size_t sector) { return sector == 0 ? 4 : 1; }
};

/// Programs words. Erasing a sector of 128 KB takes 1 to 2 s and stalls every access to flash, interrupts included:
/// meanwhile the drives must be off, and the watchdog must allow for the time.
template <typename Map>
class ChipFlash {
 public:
  ChipFlash(FlashInterface& registers, std::byte* first_sector) : registers_(registers), memory_(first_sector) {}

  static constexpr std::uintptr_t kFirstAddress = Map::kFirstAddress;

  std::size_t sector_count() const { return Map::kCount; }
  std::size_t sector_size() const { return Map::kSize; }
  std::size_t program_size() const { return sizeof(std::uint32_t); }

  std::span<const std::byte> view(std::size_t sector) const { return {at(sector, 0), sector_size()}; }

  FlashResult read(std::size_t sector, std::size_t offset, std::span<std::byte> out) {
    if (!contains(sector, offset, out.size())) return FlashResult::out_of_range;
    std::copy_n(at(sector, offset), out.size(), out.begin());
    return FlashResult::ok;
  }

  FlashResult program(std::size_t sector, std::size_t offset, std::span<const std::byte> in) {
    if (!contains(sector, offset, in.size())) return FlashResult::out_of_range;
    if (offset % program_size() != 0 || in.size() % program_size() != 0) return FlashResult::misaligned;
    unlock();
    registers_.CR = FlashInterface::kProgram | FlashInterface::kWordParallelism;
    FlashResult result = FlashResult::ok;
    for (std::size_t i = 0; i < in.size() && result == FlashResult::ok; i += program_size())
      result = program_word(at(sector, offset + i), in.subspan(i, program_size()));
    registers_.CR = FlashInterface::kLock;
    return result;
  }

  FlashResult erase(std::size_t sector) {
    if (sector >= sector_count()) return FlashResult::out_of_range;
    FlashResult result = FlashResult::ok;
    for (std::uint32_t part = 0; part < Map::count_of_chip(sector) && result == FlashResult::ok; ++part)
      result = erase_of_chip(Map::first_of_chip(sector) + part);
    return result;
  }

 private:
  FlashResult erase_of_chip(std::uint32_t number) {
    unlock();
    registers_.CR =
        FlashInterface::kSectorErase | FlashInterface::kWordParallelism | FlashInterface::sector_field(number);
    registers_.CR = registers_.CR | FlashInterface::kStart;
    const FlashResult result = finish();
    registers_.CR = FlashInterface::kLock;
    registers_.ACR = registers_.ACR & ~FlashInterface::kDataCache;  // the cache still holds the erased data (3.5.2)
    registers_.ACR = registers_.ACR | FlashInterface::kDataCacheReset;
    registers_.ACR = (registers_.ACR & ~FlashInterface::kDataCacheReset) | FlashInterface::kDataCache;
    return result;
  }

  bool contains(std::size_t sector, std::size_t offset, std::size_t size) const {
    return sector < sector_count() && offset <= sector_size() && size <= sector_size() - offset;
  }
  std::byte* at(std::size_t sector, std::size_t offset) const { return memory_ + Map::offset(sector) + offset; }

  void unlock() {
    registers_.KEYR = FlashInterface::kKey1;
    registers_.KEYR = FlashInterface::kKey2;
    registers_.SR = registers_.SR & FlashInterface::kErrors;  // writing ones clears them
  }

  FlashResult program_word(std::byte* cell, std::span<const std::byte> bytes) {
    std::uint32_t wanted = 0;
    std::uint32_t present = 0;
    std::memcpy(&wanted, bytes.data(), sizeof wanted);
    std::memcpy(&present, cell, sizeof present);
    if ((wanted & ~present) != 0) return FlashResult::not_erased;
    *reinterpret_cast<Register*>(cell) = wanted;
    return finish();
  }

  /// An erase takes at most 2 s (datasheet, table 40); 10^8 polls at 168 MHz take longer.
  FlashResult finish() {
    for (std::uint32_t poll = 0; poll < 100'000'000 && (registers_.SR & FlashInterface::kBusy) != 0; ++poll) continue;
    const bool bad = (registers_.SR & (FlashInterface::kErrors | FlashInterface::kBusy)) != 0;
    return bad ? FlashResult::hardware_error : FlashResult::ok;
  }

  FlashInterface& registers_;
  std::byte* memory_;
};
using ParameterFlash = ChipFlash<ParameterSectors>;
using ImageFlash = ChipFlash<ImageSectors>;
static_assert(Flash<ParameterFlash> && Flash<ImageFlash>);

}  // namespace hal::stm32f4
