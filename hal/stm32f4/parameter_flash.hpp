// The flash sectors that hold parameters and the fault log. RM0090, sections 3.6 and 3.9.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>

#include "hal/flash.hpp"
#include "hal/stm32f4/registers.hpp"

namespace hal::stm32f4 {

/// Sectors 8 to 11 of the STM32F405RG, 128 KB each (table 5). Programs words; erasing a sector takes 1 to 2 s and
/// stalls every access to flash, interrupts included: the watchdog must allow for it, the drives must be off.
class ParameterFlash {
 public:
  ParameterFlash(FlashInterface& registers, std::byte* first_sector) : registers_(registers), memory_(first_sector) {}

  static constexpr std::uintptr_t kFirstAddress = 0x08080000;  ///< of sector 8, table 5

  std::size_t sector_count() const { return 4; }
  std::size_t sector_size() const { return 128 * 1024; }
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
    unlock();
    registers_.CR = FlashInterface::kSectorErase | FlashInterface::kWordParallelism |
                    FlashInterface::sector_field(kFirstSector + static_cast<std::uint32_t>(sector));
    registers_.CR = registers_.CR | FlashInterface::kStart;
    const FlashResult result = finish();
    registers_.CR = FlashInterface::kLock;
    registers_.ACR = registers_.ACR & ~FlashInterface::kDataCache;  // the cache still holds what was erased (3.5.2)
    registers_.ACR = registers_.ACR | FlashInterface::kDataCacheReset;
    registers_.ACR = (registers_.ACR & ~FlashInterface::kDataCacheReset) | FlashInterface::kDataCache;
    return result;
  }

 private:
  static constexpr std::uint32_t kFirstSector = 8;

  bool contains(std::size_t sector, std::size_t offset, std::size_t size) const {
    return sector < sector_count() && offset <= sector_size() && size <= sector_size() - offset;
  }
  std::byte* at(std::size_t sector, std::size_t offset) const { return memory_ + sector * sector_size() + offset; }

  void unlock() {
    registers_.KEYR = FlashInterface::kKey1;
    registers_.KEYR = FlashInterface::kKey2;
    registers_.SR = registers_.SR & FlashInterface::kErrors;  // ones written back clear
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

  /// 2 s for an erase at most (datasheet, table 40): some 10^8 polls at 168 MHz are more.
  FlashResult finish() {
    for (std::uint32_t poll = 0; poll < 100'000'000 && (registers_.SR & FlashInterface::kBusy) != 0; ++poll) continue;
    const bool bad = (registers_.SR & (FlashInterface::kErrors | FlashInterface::kBusy)) != 0;
    return bad ? FlashResult::hardware_error : FlashResult::ok;
  }

  FlashInterface& registers_;
  std::byte* memory_;
};
static_assert(Flash<ParameterFlash>);

}  // namespace hal::stm32f4
