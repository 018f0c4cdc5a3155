// Updates a board's firmware over its USB cable.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/device/board_client.hpp"
#include "host/device/image_file.hpp"

namespace host {

/// The running program and the contents of the slots.
struct ImageSlotsSeen {
  firmware::SlotPayload program;
  std::vector<firmware::SlotPayload> slots;  ///< A, B

  bool is_on_trial() const;
};

/// Empty on a board that cannot be updated. Throws Failure (protocol) for an impossible answer.
std::optional<ImageSlotsSeen> read_slots(BoardClient& board);

/// One line for the program and one for each slot; in JSON, an entry for each slot.
std::string slots_text(const ImageSlotsSeen& seen);
nlohmann::json slots_json(const ImageSlotsSeen& seen);

/// Bytes sent, and bytes in total.
using UpdateProgress = std::function<void(std::size_t sent, std::size_t size)>;

/// Sends the image to the slot that does not run; the board checks it and starts it on trial at its next restart.
/// Throws Failure: refused (a drive is enabled, an image is on trial), bad_input (the board refuses the image; with the
/// cause), device_fault (its flash fails), and those of BoardClient.
void send_image(BoardClient& board, const ImageFile& file, const UpdateProgress& progress);

/// Confirms the running image, which becomes permanent.
void confirm_image(BoardClient& board);

/// Restarts the board and opens it again as soon as it answers; `open` may throw until then. Also waits for a second
/// restart, in case the new image does not start. After 30 s throws the last exception of `open`.
BoardClient restart_and_reopen(BoardClient board, const std::function<BoardClient()>& open);

}  // namespace host
