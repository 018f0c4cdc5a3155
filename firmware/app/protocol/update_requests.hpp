// Handles the requests for a new image of the board's program.
#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>

#include "firmware/app/board_application.hpp"
#include "firmware/app/protocol/report.hpp"
#include "firmware/app/update/image_update.hpp"

namespace firmware {

/// A board with boot code and flash for images; other boards do not know these requests.
template <typename Board>
concept UpdatableBoard = requires(Board& board) {
  requires hal::Flash<std::remove_reference_t<decltype(board.image_flash())>>;
};

template <typename Application>
class UpdateRequests {
 public:
  UpdateRequests(Application&, const ImageHeader&) {}
  static constexpr bool is_on_trial() { return false; }
  static constexpr bool trial_has_failed() { return false; }
  static Status answer(const Message&, Message&) { return Status::unknown_request; }
};

template <typename Application>
requires UpdatableBoard<typename Application::BoardType>
class UpdateRequests<Application> {
 public:
  UpdateRequests(Application& app, const ImageHeader& own)
      : app_(app), update_(app.board().image_flash(), own), is_on_trial_(update_.is_on_trial()) {}

  /// The running image was started for the first time and has not been confirmed.
  bool is_on_trial() const { return is_on_trial_; }

  /// The running image has not been confirmed in time: a reset starts the older image again.
  bool trial_has_failed() const {
    return is_on_trial_ && !app_.any_enabled() && app_.control_periods() / control_rate_Hz() >= kTrial_s;
  }

  Status answer(const Message& request, Message& reply) {
    if (request.type == MessageType::read_slot)
      return with<ReadSlotRequest>(request, [&](const ReadSlotRequest& r) { return read(r, reply); });
    if (app_.any_enabled()) return Status::drive_enabled;
    switch (request.type) {
      case MessageType::begin_update:
        if (is_on_trial_) return Status::on_trial;
        return with<BeginUpdateRequest>(request, [&](const BeginUpdateRequest& r) {
          return status_of(update_.begin(r, refusal_, stalled()), reply);
        });
      case MessageType::update_block:
        return with<UpdateBlockRequest>(
            request, [&](const UpdateBlockRequest& r) { return status_of(update_.take(r, stalled()), reply); });
      case MessageType::finish_update:
        return status_of(update_.finish(refusal_, stalled()), reply);
      default: {
        const Status status = status_of(update_.confirm(stalled()), reply);
        is_on_trial_ = update_.is_on_trial();
        return status;
      }
    }
  }

 private:
  using Flash = std::remove_reference_t<decltype(std::declval<Application&>().board().image_flash())>;
  using Slots = ImageSlots<Flash>;

  /// Long enough: a host finds the board within 5 s of its restart, as USB requires.
  static constexpr std::uint32_t kTrial_s = 30;

  std::uint32_t control_rate_Hz() const {
    return static_cast<std::uint32_t>(app_.active().template get<"control.rate">());
  }

  auto stalled() {
    return [this](auto write) { return app_.write_flash(write); };
  }

  Status status_of(UpdateResult result, Message& reply) const {
    switch (result) {
      case UpdateResult::ok:
        return Status::ok;
      case UpdateResult::flash_failed:
        return Status::flash_failed;
      case UpdateResult::not_verified:
        return Status::not_verified;
      case UpdateResult::out_of_order:
        return Status::set_differs;
      case UpdateResult::bad_image:
        break;
    }
    reply.put(RefusedImagePayload{refusal_,
                                  {},
                                  static_cast<std::uint32_t>(update_.slots().capacity()),
                                  update_.own().chip_id,
                                  update_.own().board});
    return Status::bad_image;
  }

  Status read(const ReadSlotRequest& request, Message& reply) const {
    if (request.slot > Slots::kSlots) return Status::malformed;
    const Slots& slots = update_.slots();
    const std::size_t sector = request.slot;
    const std::size_t running = slots.running_slot().value_or(Slots::kProgram);
    const bool is_program = sector == Slots::kProgram;
    SlotPayload payload;
    SlotState state = SlotState::empty;
    if (!is_program || running != Slots::kProgram) state = slots.state(is_program ? running : sector);
    payload.state = static_cast<std::uint8_t>(state);
    payload.runs = static_cast<std::uint8_t>(is_program ? running : sector == running ? 1 : 0);
    payload.number = slots.number(sector).value_or(0);
    if (is_program || state == SlotState::offered || state == SlotState::tried || state == SlotState::healthy) {
      const ImageHeader header = slots.header(sector);
      payload.size = header.image_size;
      payload.crc = header.crc;
      payload.version = header.version;
      std::copy_n(header.git_hash.begin(), payload.git_hash.size(), payload.git_hash.begin());
    }
    reply.put(payload);
    return Status::ok;
  }

  Application& app_;
  ImageUpdate<Flash> update_;
  bool is_on_trial_;
  ImageRefusal refusal_ = ImageRefusal::none;
};

}  // namespace firmware
