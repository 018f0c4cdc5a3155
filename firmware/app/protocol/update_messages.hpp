// Payloads of the requests for a new image of the program. Little-endian, in the layout of the report: README.md.
#pragma once

#include "firmware/app/protocol/messages.hpp"

namespace firmware {

/// Contents of the new image's header, so that a wrong image is refused before anything is erased.
struct BeginUpdateRequest {
  std::uint32_t size = 0;  ///< bytes
  std::uint32_t crc = 0;   ///< the header's
  std::uint32_t chip_id = 0;
  std::uint16_t layout = 0;
  std::uint16_t reserved = 0;
  std::array<char, 16> board{};
};
static_assert(sizeof(BeginUpdateRequest) == 32);

inline constexpr std::size_t kUpdateBlock = 48;

/// The next bytes of the image; those beyond its end are 0xFF.
struct UpdateBlockRequest {
  std::uint32_t offset = 0;  ///< number of bytes sent before
  std::array<std::byte, kUpdateBlock> bytes{};
};
static_assert(sizeof(UpdateBlockRequest) == kPayloadSize);

/// Why an image is refused. Numbers are permanent.
enum class ImageRefusal : std::uint8_t {
  none = 0,
  other_board = 1,
  other_chip = 2,
  other_layout = 3,  ///< another header layout: built for boards without boot code, or for later ones
  wrong_size = 4,    ///< shorter than its header says, or larger than a slot
  no_header = 5,
  wrong_crc = 6,
  not_announced = 7,  ///< another image than begin_update announced
};

/// Sent with status bad_image.
struct RefusedImagePayload {
  ImageRefusal refusal = ImageRefusal::none;
  std::array<std::uint8_t, 3> reserved{};
  std::uint32_t capacity = 0;  ///< largest size of an image, bytes
  std::uint32_t chip_id = 0;   ///< of the board
  std::array<char, 16> board{};
};
static_assert(sizeof(RefusedImagePayload) == 28);

struct ReadSlotRequest {
  std::uint8_t slot = 0;  ///< 0: the running program, 1: slot A, 2: slot B
};

/// Version, size and checksum are those of the image's header; 0 unless the slot is offered, tried or healthy.
struct SlotPayload {
  std::uint8_t state = 0;  ///< SlotState; for the running program, that of its slot
  std::uint8_t runs = 0;   ///< 1: the running program was copied from this slot; for the program: its slot, 0 if none
  std::uint16_t reserved = 0;
  std::uint32_t number = 0;  ///< of the update that installed it; 0: none
  std::uint32_t size = 0;
  std::uint32_t crc = 0;
  std::array<char, 16> version{};
  std::array<char, 12> git_hash{};  ///< its first characters; may lack the zero at the end
};
static_assert(sizeof(SlotPayload) == 44);

}  // namespace firmware
