#include "tests/hal/parts/flash_part.hpp"

#include <algorithm>
#include <cstring>

namespace parts {

namespace {

constexpr std::uint32_t kKilobyte = 1024;
constexpr unsigned kSectors = 12;  // table 5: four of 16 KB, one of 64, seven of 128
constexpr std::uint32_t kBoundaries[kSectors + 1] = {0, 16, 32, 48, 64, 128, 256, 384, 512, 640, 768, 896, 1024};
constexpr std::uint32_t kWriteProtected = 1u << 4, kParallelismError = 1u << 6,
                        kSequenceError = 1u << 7;                             // 3.9.4
constexpr std::uint32_t kDataCacheOn = 1u << 10, kDataCacheReset = 1u << 12;  // 3.9.1

}  // namespace

FlashPart::FlashPart(Bus& bus) : bus_(bus), memory_(0x08000000 + kBoundaries[1] * kKilobyte, begin_of(kSectors)) {
  std::fill(cells_.begin(), cells_.end(), std::byte{0xFF});
  bus.attach(reinterpret_cast<std::uintptr_t>(cells_.data()), static_cast<std::uint32_t>(cells_.size()), cells_part_);
}

std::uint32_t FlashPart::begin_of(unsigned sector) { return (kBoundaries[sector] - kBoundaries[1]) * kKilobyte; }

void FlashPart::reset() {
  access_ = status_ = control_ = 0;
  locked_ = true;
  half_unlocked_ = jammed_ = false;
}

std::uint32_t FlashPart::Cells::read(std::uint32_t offset) {
  if (flash_.is_busy()) flash_.bus_.pass_ns(flash_.busy_until_ns_ - flash_.bus_.now_ns());  // 3.6: the bus stalls
  std::uint32_t word = 0;
  std::memcpy(&word, flash_.cells_.data() + offset, sizeof word);
  return word;
}

std::uint32_t FlashPart::read(std::uint32_t offset) {
  switch (offset) {
    case 0x00:
      return access_;
    case 0x0C:
      // The program itself lies in flash: at most the code in the instruction cache keeps running (3.5.2).
      if (is_busy()) bus_.pass_ns(10'000);
      return status_ | (is_busy() ? 1u << 16 : 0u);
    case 0x10:
      return control_ | (locked_ ? 1u << 31 : 0u);
    case 0x14:
      return option_bytes;
    default:
      return 0;
  }
}

void FlashPart::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x00:
      // 3.9.1: the cache can be reset only while it is off.
      if ((value & kDataCacheReset) != 0 && (access_ & kDataCacheOn) != 0)
        bus_.complain("flash: data cache reset while it is on");
      if ((value & kDataCacheReset) != 0 && (access_ & kDataCacheOn) == 0) cache_is_stale_ = false;
      access_ = value;
      break;
    case 0x04:  // 3.6.1: two keys in this order; a wrong one locks until the next reset
      if (locked_ && !half_unlocked_ && !jammed_ && value == 0x45670123)
        half_unlocked_ = true;
      else if (half_unlocked_ && value == 0xCDEF89AB)
        locked_ = half_unlocked_ = false;
      else
        jammed_ = locked_ = true;
      break;
    case 0x0C:
      status_ &= ~(value & 0xF3u);
      break;
    case 0x10:
      write_control(value);
      break;
    default:
      break;
  }
}

void FlashPart::write_control(std::uint32_t value) {
  if (locked_) {
    if ((value & ~(1u << 31)) != 0) bus_.complain("flash: control register written while it is locked");
    return;
  }
  if (is_busy()) bus_.complain("flash: control register written during an operation");  // 3.9.5
  control_ = value & 0x7FFFFFFF;
  if (bits(control_, 16) != 0) begin_erase();
  control_ &= ~(1u << 16);
  if (bits(value, 31) != 0) locked_ = true;
}

void FlashPart::begin_erase() {
  if (bits(control_, 1) == 0) return;
  const unsigned sector = bits(control_, 3, 4);
  if (bits(control_, 0) != 0 || bits(control_, 8, 2) != 2) bus_.complain("flash: erase set up wrongly");
  if (is_protected) {
    status_ |= kWriteProtected;
    return;
  }
  busy_until_ns_ = never_ends ? 1e30 : bus_.now_ns() + erase_ns;
  if ((access_ & kDataCacheOn) != 0) cache_is_stale_ = true;
  if (sector == 0 || sector >= kSectors) return bus_.complain("flash: erased a sector that holds something else");
  std::fill(cells_.begin() + begin_of(sector), cells_.begin() + begin_of(sector + 1), std::byte{0xFF});
}

void FlashPart::program(std::uint32_t offset, std::uint32_t value) {
  if (is_busy()) {
    bus_.complain("flash: written during an operation: the bus stalls");
    bus_.pass_ns(busy_until_ns_ - bus_.now_ns());
  }
  if (locked_ || bits(control_, 0) == 0) {
    status_ |= kSequenceError;
    return;
  }
  if (bits(control_, 8, 2) != 2) {  // 3.6.2: words take x32
    status_ |= kParallelismError;
    return;
  }
  if (is_protected) {
    status_ |= kWriteProtected;
    return;
  }
  busy_until_ns_ = bus_.now_ns() + program_ns;
  std::uint32_t word = 0;
  std::memcpy(&word, cells_.data() + offset, sizeof word);
  word &= value;
  std::memcpy(cells_.data() + offset, &word, sizeof word);
}

void FlashPart::run(double now_ns) {
  if (is_busy() && now_ns >= busy_until_ns_) busy_until_ns_ = 0.0;
}

}  // namespace parts
