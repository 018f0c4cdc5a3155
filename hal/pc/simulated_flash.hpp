// Parameter flash in memory, with the microcontroller's rules: programming turns ones into zeros; only an erase
// restores ones. Power can be cut at any operation.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "hal/flash.hpp"

namespace hal::pc {

/// Thrown by the operation during which power fails. Not an error of the program: only a test catches it.
struct PowerCut {};

/// State in which an interrupted operation leaves its word (program) or its sector (erase).
enum class TornState : std::uint8_t {
  untouched,  ///< as it was before
  complete,   ///< as it should have become
  partial,    ///< some of the bits that should have changed
  prefix,     ///< erase: the first half done, then some bits; program: the low half of the word
};
inline constexpr TornState kTornStates[] = {TornState::untouched, TornState::complete, TornState::partial,
                                            TornState::prefix};

class SimulatedFlash {
 public:
  /// Initially erased. `program_size` divides `sector_size`, and so does `erase_parts`, the number of parts of a sector
  /// that are erased one by one.
  SimulatedFlash(std::size_t sector_count, std::size_t sector_size, std::size_t program_size,
                 std::size_t erase_parts = 1)
      : sectors_(sector_count, std::vector<std::byte>(sector_size, kErased)),
        program_size_(program_size),
        erase_parts_(erase_parts) {}

  std::size_t sector_count() const { return sectors_.size(); }
  std::size_t sector_size() const { return sectors_.empty() ? 0 : sectors_.front().size(); }
  std::size_t program_size() const { return program_size_; }

  std::span<const std::byte> view(std::size_t sector) const { return sectors_[sector]; }

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
      change({cell, program_size_}, {wanted, program_size_});
    }
    return FlashResult::ok;
  }

  FlashResult erase(std::size_t sector) {
    if (sector >= sectors_.size()) return FlashResult::out_of_range;
    const std::size_t size = sector_size() / erase_parts_;
    for (std::size_t part = 0; part < erase_parts_; ++part)
      change(std::span(sectors_[sector]).subspan(part * size, size), std::vector<std::byte>(size, kErased));
    return FlashResult::ok;
  }

  /// Power fails during the operation after the next `operations`, each an erase of a sector's part or one programmed
  /// unit.
  void cut_power_after(std::size_t operations, TornState torn, std::uint32_t seed) {
    cut_ = Cut{operations_ + operations, torn, seed};
  }
  void restore_power() { cut_.reset(); }

  /// Erases and programmed units so far.
  std::size_t operations() const { return operations_; }

  /// Its whole contents, sector after sector, to be stored in a file or deliberately damaged.
  std::vector<std::vector<std::byte>>& contents() { return sectors_; }

 private:
  struct Cut {
    std::size_t operation;
    TornState torn;
    std::uint32_t seed;
  };

  static constexpr std::byte kErased{0xFF};

  void change(std::span<std::byte> cells, std::span<const std::byte> wanted) {
    const bool cut = cut_ && cut_->operation == operations_;
    ++operations_;
    if (!cut) {
      std::ranges::copy(wanted, cells.begin());
      return;
    }
    std::mt19937 chance(cut_->seed);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool done = cut_->torn == TornState::complete || (cut_->torn == TornState::prefix && i < cells.size() / 2);
      std::byte mask = done ? std::byte{0xFF} : std::byte{0};
      if (cut_->torn == TornState::partial ||
          (cut_->torn == TornState::prefix && !done && cells.size() > program_size_))
        mask = static_cast<std::byte>(chance() & 0xFF);
      cells[i] = (cells[i] & ~mask) | (wanted[i] & mask);
    }
    throw PowerCut{};
  }

  bool contains(std::size_t sector, std::size_t offset, std::size_t size) const {
    return sector < sectors_.size() && offset <= sector_size() && size <= sector_size() - offset;
  }

  std::vector<std::vector<std::byte>> sectors_;
  std::size_t program_size_, erase_parts_;
  std::size_t operations_ = 0;
  std::optional<Cut> cut_;
};

static_assert(Flash<SimulatedFlash>);

}  // namespace hal::pc
