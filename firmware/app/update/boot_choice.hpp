// What the boot code does before it starts the program: chooses a slot, and copies it to where programs run.
#pragma once

#include "firmware/app/update/image_slots.hpp"

namespace firmware {

enum class BootResult : std::uint8_t {
  nothing,   ///< no whole image lies in the program's place
  program,   ///< one does
  on_trial,  ///< likewise, and it has not reported yet that it is healthy
};

/// The newest image that has not failed runs. It is copied into the program's place unless it is there; a slot is never
/// changed but for its marks, so a power cut at any moment is mended by doing all of this again. An image that was
/// never started is marked as tried first: unless that run reports that it is healthy, the older image returns at the
/// next reset. A program that `axistool flash` put there runs as it is.
template <hal::Flash Flash>
class BootChoice {
 public:
  explicit constexpr BootChoice(Flash& flash) : flash_(flash), slots_(flash) {}

  BootResult prepare() {
    if (slots_.is_program_flashed() && slots_.is_whole(kProgram)) return BootResult::program;
    std::array<bool, Slots::kSlots> is_out{};
    for (std::size_t tries = 0; tries < Slots::kSlots; ++tries) {
      const auto slot = newest(is_out);
      if (!slot) break;
      if (is_in_place(*slot) || copy(*slot)) {
        if (slots_.state(*slot) == SlotState::healthy) return BootResult::program;
        if (slots_.mark_tried(*slot)) return BootResult::on_trial;
      }
      is_out[*slot - Slots::kFirstSlot] = true;
    }
    // Better than nothing, whatever became of its slot.
    return slots_.is_whole(kProgram) ? BootResult::program : BootResult::nothing;
  }

 private:
  using Slots = ImageSlots<Flash>;
  static constexpr std::size_t kProgram = Slots::kProgram;

  std::optional<std::size_t> newest(const std::array<bool, Slots::kSlots>& is_out) const {
    std::optional<std::size_t> found;
    for (std::size_t slot = Slots::kFirstSlot; slot < Slots::kFirstSlot + Slots::kSlots; ++slot) {
      if (is_out[slot - Slots::kFirstSlot] || !slots_.is_usable(slot)) continue;
      if (!found || slots_.number(slot) > slots_.number(*found)) found = slot;
    }
    return found;
  }

  bool is_in_place(std::size_t slot) const { return slots_.running_slot() == slot && slots_.is_whole(kProgram); }

  /// The number goes first: where the image is whole, its number is there too.
  bool copy(std::size_t slot) {
    if (!slots_.is_whole(slot)) return false;
    if (flash_.erase(kProgram) != hal::FlashResult::ok || !slots_.put_number(kProgram, *slots_.number(slot)))
      return false;
    const std::size_t unit = flash_.program_size();
    const std::size_t size = (slots_.header(slot).image_size + unit - 1) / unit * unit;
    const auto image = flash_.view(slot).first(size);
    return flash_.program(kProgram, 0, image) == hal::FlashResult::ok &&
           std::ranges::equal(flash_.view(kProgram).first(size), image);
  }

  Flash& flash_;
  Slots slots_;
};

}  // namespace firmware
