// Work of the boot code before it starts the program: chooses a slot and copies it to the program's place.
#pragma once

#include "firmware/app/update/image_slots.hpp"

namespace firmware {

enum class BootResult : std::uint8_t {
  nothing,   ///< there is no complete image in the program's place
  program,   ///< there is a complete image
  on_trial,  ///< there is a complete image that has not yet reported that it is healthy
};

/// Runs the newest image that has not failed, after copying it to the program's place unless it is already there. In
/// the slots only marks change, so after a power cut at any time the next start repeats all of this. An image that was
/// never started is first marked as tried; unless its run reports that it is healthy, the older image returns at the
/// next reset. A program that `axistool flash` wrote runs unchanged.
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
    // Starts it as a last resort, whatever the state of its slot.
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

  /// The number is written first, so that a complete image always has its number.
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
