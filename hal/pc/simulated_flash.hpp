// Parameter flash in memory, with the microcontroller's rules: ones become zeros, only an erase brings them back.
#pragma once

#include <algorithm>
#include <vector>

#include "hal/flash.hpp"

namespace hal::pc {

class SimulatedFlash {
 public:
  /// All erased. `program_size` divides `sector_size`.
  SimulatedFlash(std::size_t sector_count, std::size_t sector_size, std::size_t program_size)
      : sectors_(sector_count, std::vector<std::byte>(sector_size, kErased)), program_size_(program_size) {}

  std::size_t sector_count() const { return sectors_.size(); }
  std::size_t sector_size() const { return sectors_.empty() ? 0 : sectors_.front().size(); }
  std::size_t program_size() const { return program_size_; }

  FlashResult read(std::size_t sector, std::size_t offset, std::span<std::byte> out) {
    if (!contains(sector, offset, out.size())) return FlashResult::out_of_range;
    std::copy_n(sectors_[sector].begin() + static_cast<std::ptrdiff_t>(offset), out.size(), out.begin());
    return FlashResult::ok;
  }

  FlashResult program(std::size_t sector, std::size_t offset, std::span<const std::byte> in) {
    if (!contains(sector, offset, in.size())) return FlashResult::out_of_range;
    if (offset % program_size_ != 0 || in.size() % program_size_ != 0) return FlashResult::misaligned;
    for (std::size_t unit = 0; unit < in.size(); unit += program_size_) {
      std::byte* cell = sectors_[sector].data() + offset + unit;
      const std::byte* wanted = in.data() + unit;
      if (!std::equal(wanted, wanted + program_size_, cell,
                      [](std::byte want, std::byte have) { return (want & ~have) == std::byte{0}; }))
        return FlashResult::not_erased;
      std::copy_n(wanted, program_size_, cell);
    }
    return FlashResult::ok;
  }

  FlashResult erase(std::size_t sector) {
    if (sector >= sectors_.size()) return FlashResult::out_of_range;
    std::fill(sectors_[sector].begin(), sectors_[sector].end(), kErased);
    return FlashResult::ok;
  }

 private:
  static constexpr std::byte kErased{0xFF};

  bool contains(std::size_t sector, std::size_t offset, std::size_t size) const {
    return sector < sectors_.size() && offset <= sector_size() && size <= sector_size() - offset;
  }

  std::vector<std::vector<std::byte>> sectors_;
  std::size_t program_size_;
};

static_assert(Flash<SimulatedFlash>);

}  // namespace hal::pc
