// The flash interface and some sectors of flash behind it. RM0090, chapter 3.
#pragma once

#include <cstddef>

#include "tests/hal/parts/bus.hpp"
#include "tests/hal/parts/memory_at.hpp"

namespace parts {

class FlashPart : public Part {
 public:
  /// All sectors but the first, in which the boot code lies; at their place in the address space (table 5).
  explicit FlashPart(Bus& bus);

  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void run(double now_ns) override;
  void reset() override;

  /// The sector as the processor reads it; the next sector follows.
  std::byte* sector(unsigned number) { return cells_.data() + begin_of(number); }
  unsigned wait_states() const { return access_ & 7u; }
  bool cache_is_stale() const { return cache_is_stale_; }
  bool is_locked() const { return locked_; }

  double erase_ns = 2e9;      ///< datasheet, table 40: 1 s, at most 2 s
  double program_ns = 100e3;  ///< 16 us, at most 100 us
  bool is_protected = false;  ///< option bytes protect the sectors (WRPERR)
  bool never_ends = false;
  std::uint32_t option_bytes = 0x0FFFAAED;  ///< OPTCR as delivered: brown-out reset off (3.9.10; 3.6, table 15)

 private:
  /// The memory itself, as programs write it.
  class Cells : public Part {
   public:
    explicit Cells(FlashPart& flash) : flash_(flash) {}
    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override { flash_.program(offset, value); }
    void reset() override {}

   private:
    FlashPart& flash_;
  };

  void program(std::uint32_t offset, std::uint32_t value);
  void begin_erase();
  void write_control(std::uint32_t value);
  bool is_busy() const { return busy_until_ns_ > 0.0; }
  static std::uint32_t begin_of(unsigned sector);

  Bus& bus_;
  MemoryAt memory_;
  std::span<std::byte> cells_ = memory_.bytes();
  Cells cells_part_{*this};
  std::uint32_t access_ = 0, status_ = 0, control_ = 0;
  bool locked_ = true, half_unlocked_ = false, jammed_ = false, cache_is_stale_ = false;
  double busy_until_ns_ = 0.0;
};

}  // namespace parts
