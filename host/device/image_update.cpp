#include "host/device/image_update.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <thread>

#include "firmware/app/update/image_slots.hpp"
#include "host/exit_codes.hpp"

namespace host {

namespace {

using firmware::MessageType;
using firmware::SlotState;

/// Three erases of a sector (STM32F405 datasheet, table 40: 2 s each at most), and a copy of the running image.
constexpr std::chrono::milliseconds kBeginPatience{15'000};
/// A block is programmed within a millisecond, but the fault log may be erasing a sector.
constexpr std::chrono::milliseconds kBlockPatience{5000};
constexpr std::array<std::string_view, 5> kSlotStates{"empty", "incomplete", "offered", "tried", "healthy"};
constexpr std::array<const char*, 2> kSlotNames{"A", "B"};

template <std::size_t size>
std::string printable(const std::array<char, size>& padded) {
  std::string text(padded.data(), std::find(padded.begin(), padded.end(), '\0'));
  std::ranges::replace_if(
      text, [](char one) { return one < ' ' || one > '~'; }, '?');
  return text;
}

std::string version_of(const firmware::SlotPayload& slot) {
  const std::string commit = printable(slot.git_hash);
  return printable(slot.version) + (commit.empty() ? "" : " " + commit);
}

std::string state_of(const firmware::SlotPayload& slot) {
  if (static_cast<SlotState>(slot.state) == SlotState::tried) return slot.runs != 0 ? "on trial" : "failed";
  return std::string(kSlotStates.at(slot.state));
}

bool holds_image(const firmware::SlotPayload& slot) {
  return slot.state >= static_cast<std::uint8_t>(SlotState::offered);
}

firmware::SlotPayload read_one(BoardClient& board, std::uint8_t sector) {
  const auto slot = board.read_slot(sector);
  const std::size_t most_runs = sector == 0 ? kSlotNames.size() : 1;
  if (!slot || slot->state >= kSlotStates.size() || slot->runs > most_runs)
    throw Failure(ExitCode::protocol, "the board reports an impossible slot of images");
  return *slot;
}

firmware::Message update_message(MessageType type) {
  firmware::Message message;
  message.type = type;
  return message;
}

}  // namespace

bool ImageSlotsSeen::is_on_trial() const {
  return program.runs != 0 && static_cast<SlotState>(program.state) == SlotState::tried;
}

std::optional<ImageSlotsSeen> read_slots(BoardClient& board) {
  if (!board.read_slot(0)) return std::nullopt;
  ImageSlotsSeen seen{read_one(board, 0), {}};
  for (std::uint8_t slot = 1; slot <= kSlotNames.size(); ++slot) seen.slots.push_back(read_one(board, slot));
  return seen;
}

std::string slots_text(const ImageSlotsSeen& seen) {
  std::string text = seen.program.runs == 0
                         ? std::string("runs         what axistool flash wrote\n")
                         : fmt::format("runs         slot {}{}\n", kSlotNames[seen.program.runs - 1u],
                                       seen.is_on_trial() ? ", on trial" : "");
  for (std::size_t i = 0; i < seen.slots.size(); ++i) {
    const firmware::SlotPayload& slot = seen.slots[i];
    text += fmt::format("slot {}       {}", kSlotNames[i], state_of(slot));
    if (holds_image(slot))
      text += fmt::format(", version {}, {} bytes, update {}", version_of(slot), slot.size, slot.number);
    text += "\n";
  }
  return text;
}

nlohmann::json slots_json(const ImageSlotsSeen& seen) {
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = 0; i < seen.slots.size(); ++i) {
    const firmware::SlotPayload& slot = seen.slots[i];
    list.push_back({{"slot", kSlotNames[i]}, {"state", state_of(slot)}, {"runs", slot.runs != 0}});
    if (holds_image(slot))
      list.back().update({{"version", printable(slot.version)},
                          {"git_hash", printable(slot.git_hash)},
                          {"size", slot.size},
                          {"crc32", slot.crc},
                          {"update", slot.number}});
  }
  return list;
}

void send_image(BoardClient& board, const ImageFile& file, const UpdateProgress& progress) {
  const auto image = file.image();
  const firmware::ImageHeader& header = file.header;
  firmware::Message message = update_message(MessageType::begin_update);
  message.put(
      firmware::BeginUpdateRequest{header.image_size, header.crc, header.chip_id, header.layout, 0, header.board});
  board.exchange(message, std::max(kBeginPatience, board.patience()));
  for (std::size_t offset = 0; offset < image.size(); offset += firmware::kUpdateBlock) {
    firmware::UpdateBlockRequest block;
    block.offset = static_cast<std::uint32_t>(offset);
    block.bytes.fill(std::byte{0xFF});
    std::ranges::copy(image.subspan(offset, std::min(firmware::kUpdateBlock, image.size() - offset)),
                      block.bytes.begin());
    message = update_message(MessageType::update_block);
    message.put(block);
    board.exchange(message, std::max(kBlockPatience, board.patience()));
    progress(std::min(offset + firmware::kUpdateBlock, image.size()), image.size());
  }
  board.exchange(update_message(MessageType::finish_update), std::max(kBlockPatience, board.patience()));
}

void confirm_image(BoardClient& board) {
  board.exchange(update_message(MessageType::confirm_update), std::max(kBlockPatience, board.patience()));
}

BoardClient restart_and_reopen(BoardClient board, const std::function<BoardClient()>& open) {
  constexpr std::chrono::seconds kLimit{30};
  constexpr std::chrono::milliseconds kRestart{500};  // 20 ms until the reset, then USB disconnects
  board.restart();
  board.wait(kRestart);
  const auto end = std::chrono::steady_clock::now() + kLimit;
  try {
    board.identify();  // succeeds if the board is simulated in this process: its link survives a restart
    return board;
  } catch (const Failure&) {
    const BoardClient gone = std::move(board);  // closes the link, so that the board can be opened again
  }
  for (;;) {
    try {
      BoardClient again = open();
      again.identify();
      return again;
    } catch (const Failure&) {
      if (std::chrono::steady_clock::now() > end) throw;
      std::this_thread::sleep_for(kRestart / 2);
    }
  }
}

}  // namespace host
