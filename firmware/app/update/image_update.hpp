// Receives a new image block by block into the slot that does not hold the running program.
#pragma once

#include "firmware/app/protocol/update_messages.hpp"
#include "firmware/app/update/image_slots.hpp"

namespace firmware {

enum class UpdateResult : std::uint8_t { ok, flash_failed, not_verified, bad_image, out_of_order };

/// Writes only the slots' sectors, and in the program's place only the number. The running image stays in its slot,
/// marked as healthy, so that it can return. The last word that is written offers the new image to the boot code. Each
/// step stalls the processor for at most one erase, through `stalled`, which is called with the work to be done
/// meanwhile.
template <hal::Flash Flash>
class ImageUpdate {
 public:
  /// `own`: the header of the running image; an image for another board or chip is refused.
  constexpr ImageUpdate(Flash& flash, const ImageHeader& own) : flash_(flash), slots_(flash), own_(own) {}

  const ImageSlots<Flash>& slots() const { return slots_; }
  const ImageHeader& own() const { return own_; }

  /// The running program was started for the first time; unless it is confirmed, an older image returns.
  bool is_on_trial() const {
    const auto running = slots_.running_slot();
    return running && slots_.state(*running) == SlotState::tried && slots_.is_usable(other_than(*running));
  }

  /// Makes the running program permanent.
  template <typename Stalled>
  UpdateResult confirm(Stalled stalled) {
    const auto running = slots_.running_slot();
    if (!running || slots_.state(*running) == SlotState::healthy) return UpdateResult::ok;
    return stalled([&] { return slots_.mark_healthy(*running); }) ? UpdateResult::ok : UpdateResult::flash_failed;
  }

  /// Erases the other slot. If the running image is in no slot, as after `axistool flash`, copies it to one first.
  template <typename Stalled>
  UpdateResult begin(const BeginUpdateRequest& announced, ImageRefusal& refusal, Stalled stalled) {
    is_receiving_ = false;
    refusal = refusal_of(announced);
    if (refusal != ImageRefusal::none) return UpdateResult::bad_image;
    const UpdateResult kept = slots_.running_slot() ? confirm(stalled) : keep_running(stalled);
    if (kept != UpdateResult::ok) return kept;
    target_ = other_than(*slots_.running_slot());
    if (stalled([&] { return flash_.erase(target_); }) != hal::FlashResult::ok) return UpdateResult::flash_failed;
    announced_ = announced;
    received_ = 0;
    is_receiving_ = true;
    return UpdateResult::ok;
  }

  template <typename Stalled>
  UpdateResult take(const UpdateBlockRequest& block, Stalled stalled) {
    if (!is_receiving_ || block.offset != received_ || received_ >= announced_.size) return UpdateResult::out_of_order;
    const std::size_t wanted = std::min<std::size_t>(kUpdateBlock, rounded_up(announced_.size - received_));
    const auto bytes = std::span(block.bytes).first(wanted);
    if (stalled([&] { return flash_.program(target_, received_, bytes); }) != hal::FlashResult::ok) {
      is_receiving_ = false;
      return UpdateResult::flash_failed;
    }
    received_ += static_cast<std::uint32_t>(kUpdateBlock);
    return UpdateResult::ok;
  }

  /// Offers the image to the boot code if it is complete and the announced one. The update is over in either case.
  template <typename Stalled>
  UpdateResult finish(ImageRefusal& refusal, Stalled stalled) {
    if (!is_receiving_) return UpdateResult::out_of_order;
    is_receiving_ = false;
    refusal = refusal_of_received();
    if (refusal != ImageRefusal::none) return UpdateResult::bad_image;
    const std::uint32_t number = slots_.highest_number() + 1;
    const bool is_offered =
        stalled([&] { return slots_.put_number(target_, number) && slots_.mark_complete(target_); });
    return is_offered ? UpdateResult::ok : UpdateResult::not_verified;
  }

 private:
  using Slots = ImageSlots<Flash>;
  static constexpr std::size_t kPiece = 4096;  ///< 1024 words of 16 us, at most 100 us (datasheet, table 40): 0.1 s

  static constexpr std::size_t other_than(std::size_t slot) { return slot == Slots::kFirstSlot ? slot + 1 : slot - 1; }

  std::size_t rounded_up(std::size_t size) const {
    const std::size_t unit = flash_.program_size();
    return (size + unit - 1) / unit * unit;
  }

  ImageRefusal refusal_of(const BeginUpdateRequest& image) const {
    if (image.board != own_.board) return ImageRefusal::other_board;
    if (image.chip_id != own_.chip_id) return ImageRefusal::other_chip;
    if (image.layout != kImageLayout) return ImageRefusal::other_layout;
    const bool fits = image.size >= kImageHeaderOffset + sizeof(ImageHeader) && image.size <= slots_.capacity();
    return fits ? ImageRefusal::none : ImageRefusal::wrong_size;
  }

  ImageRefusal refusal_of_received() const {
    ImageHeader header;
    const ImageState state = examine_image(slots_.memory(target_).first(announced_.size), header);
    if (state == ImageState::no_header) return ImageRefusal::no_header;
    if (state == ImageState::wrong_size || received_ < announced_.size) return ImageRefusal::wrong_size;
    if (state == ImageState::wrong_crc) return ImageRefusal::wrong_crc;
    const bool is_announced = header.image_size == announced_.size && header.crc == announced_.crc &&
                              header.board == announced_.board && header.chip_id == announced_.chip_id;
    return is_announced ? ImageRefusal::none : ImageRefusal::not_announced;
  }

  /// Marks it as healthy and newest before the program's place gets its number, from which on the slots are used.
  template <typename Stalled>
  UpdateResult keep_running(Stalled stalled) {
    constexpr std::size_t kKeeper = Slots::kFirstSlot;
    if (!slots_.is_whole(Slots::kProgram)) return UpdateResult::not_verified;
    const auto present = slots_.number(Slots::kProgram);  // the slot may have been damaged meanwhile
    const std::uint32_t number = present.value_or(slots_.highest_number() + 1);
    const auto image = flash_.view(Slots::kProgram).first(rounded_up(slots_.header(Slots::kProgram).image_size));
    if (stalled([&] { return flash_.erase(kKeeper); }) != hal::FlashResult::ok) return UpdateResult::flash_failed;
    for (std::size_t offset = 0; offset < image.size(); offset += kPiece) {
      const auto piece = image.subspan(offset, std::min(kPiece, image.size() - offset));
      if (stalled([&] { return flash_.program(kKeeper, offset, piece); }) != hal::FlashResult::ok)
        return UpdateResult::flash_failed;
    }
    if (!std::ranges::equal(flash_.view(kKeeper).first(image.size()), image)) return UpdateResult::not_verified;
    const bool is_kept = stalled([&] {
      return slots_.put_number(kKeeper, number) && slots_.mark_healthy(kKeeper) && slots_.mark_complete(kKeeper) &&
             (present || slots_.put_number(Slots::kProgram, number));
    });
    return is_kept ? UpdateResult::ok : UpdateResult::not_verified;
  }

  Flash& flash_;
  Slots slots_;
  const ImageHeader& own_;
  BeginUpdateRequest announced_{};
  std::size_t target_ = Slots::kFirstSlot;
  std::uint32_t received_ = 0;
  bool is_receiving_ = false;
};

}  // namespace firmware
