// The flash for programs: the place where a program runs, two slots that keep images for it, and the words with their
// states.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <span>

#include "firmware/app/image_header.hpp"
#include "firmware/app/store/stored_set.hpp"
#include "hal/flash.hpp"

namespace firmware {

/// Words after the image at the end of each sector, programmed one by one. A slot has all of them. The program's place
/// has only the number, that of the slot from which it was copied; after `axistool flash` it has none.
struct SlotMarks {
  std::uint32_t number = 0;    ///< of the update, counted from 1; a higher number is newer
  std::uint32_t inverse = 0;   ///< ~number: shows a partly programmed number
  std::uint32_t complete = 0;  ///< kValidMark once the whole image has been verified: offered to the boot code
  std::uint32_t tried = 0;     ///< differs from kNotProgrammed once the boot code has started it
  std::uint32_t healthy = 0;   ///< kValidMark once a run of it has reported that it is healthy
  std::array<std::uint32_t, 3> reserved{};
};
static_assert(sizeof(SlotMarks) == 32 && std::is_trivially_copyable_v<SlotMarks>);

/// Numbers are permanent, because replies contain them.
enum class SlotState : std::uint8_t {
  empty = 0,       ///< erased
  incomplete = 1,  ///< being written, or interrupted by a power cut
  offered = 2,     ///< whole; the boot code starts it at the next reset
  tried = 3,       ///< was started but has not reported that it is healthy: on trial while it runs, failed afterwards
  healthy = 4,
};

/// Three sectors of a flash: the program's place and the slots. Shared by the boot code, which reads the marks and
/// fills the program's place, and by the program, which fills slots.
template <hal::Flash Flash>
class ImageSlots {
 public:
  static constexpr std::size_t kProgram = 0, kFirstSlot = 1, kSlots = 2;

  explicit constexpr ImageSlots(Flash& flash) : flash_(flash) {}

  /// Largest size of an image, bytes.
  std::size_t capacity() const { return flash_.sector_size() - sizeof(SlotMarks); }

  std::span<const std::byte> memory(std::size_t sector) const { return flash_.view(sector).first(capacity()); }

  SlotMarks marks(std::size_t sector) const {
    SlotMarks marks;
    std::memcpy(&marks, flash_.view(sector).data() + capacity(), sizeof marks);
    return marks;
  }

  /// The number of a sector; empty if it has none, or only a partly programmed one.
  std::optional<std::uint32_t> number(std::size_t sector) const {
    const SlotMarks found = marks(sector);
    return found.number == ~found.inverse ? std::optional(found.number) : std::nullopt;
  }

  SlotState state(std::size_t slot) const {
    const SlotMarks found = marks(slot);
    if (number(slot) && found.complete == kValidMark) {
      if (found.healthy == kValidMark) return SlotState::healthy;
      return found.tried == kNotProgrammed ? SlotState::offered : SlotState::tried;
    }
    const bool is_blank = std::ranges::all_of(flash_.view(slot), [](std::byte one) { return one == std::byte{0xFF}; });
    return is_blank ? SlotState::empty : SlotState::incomplete;
  }

  /// Whether the boot code may start it: it is complete and has not failed.
  bool is_usable(std::size_t slot) const {
    const SlotMarks found = marks(slot);
    return number(slot) && found.complete == kValidMark &&
           (found.healthy == kValidMark || found.tried == kNotProgrammed);
  }

  /// The slot from which the program was copied, found by its number and by the checksum in both headers.
  std::optional<std::size_t> running_slot() const {
    const auto wanted = number(kProgram);
    for (std::size_t slot = kFirstSlot; wanted && slot < kFirstSlot + kSlots; ++slot)
      if (number(slot) == wanted && marks(slot).complete == kValidMark && header(slot).crc == header(kProgram).crc)
        return slot;
    return std::nullopt;
  }

  /// `axistool flash`, not the boot code, wrote the program's place: then the slots are not used.
  bool is_program_flashed() const {
    const SlotMarks found = marks(kProgram);
    return found.number == kNotProgrammed && found.inverse == kNotProgrammed;
  }

  /// The header as stored, without checks.
  ImageHeader header(std::size_t sector) const {
    ImageHeader header;
    std::memcpy(&header, flash_.view(sector).data() + kImageHeaderOffset, sizeof header);
    return header;
  }

  /// Reads the whole image.
  bool is_whole(std::size_t sector) const {
    ImageHeader ignored;
    return examine_image(memory(sector), ignored) == ImageState::whole;
  }

  std::uint32_t highest_number() const {
    std::uint32_t highest = 0;
    for (std::size_t sector = kProgram; sector < kFirstSlot + kSlots; ++sector)
      highest = std::max(highest, number(sector).value_or(0));
    return highest;
  }

  /// False if the flash fails, or reads back differently.
  bool put_number(std::size_t sector, std::uint32_t number) {
    return put(sector, offsetof(SlotMarks, number), number) && put(sector, offsetof(SlotMarks, inverse), ~number);
  }
  bool mark_complete(std::size_t slot) { return put(slot, offsetof(SlotMarks, complete), kValidMark); }
  bool mark_tried(std::size_t slot) { return put(slot, offsetof(SlotMarks, tried), 0); }
  bool mark_healthy(std::size_t slot) { return put(slot, offsetof(SlotMarks, healthy), kValidMark); }

 private:
  bool put(std::size_t sector, std::size_t offset, std::uint32_t word) {
    const auto bytes = std::as_bytes(std::span(&word, 1));
    if (flash_.program(sector, capacity() + offset, bytes) != hal::FlashResult::ok) return false;
    std::uint32_t back = ~word;
    std::memcpy(&back, flash_.view(sector).data() + capacity() + offset, sizeof back);
    return back == word;
  }

  Flash& flash_;
};

}  // namespace firmware
