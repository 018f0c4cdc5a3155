// Header of an image, 512 bytes after its start: board and chip, version, and a checksum.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "firmware/app/crc32.hpp"

namespace firmware {

/// Little-endian; texts are padded with zeros and end in one.
struct ImageHeader {
  std::uint32_t magic = 0;
  std::uint16_t layout = 0;
  std::uint16_t header_size = 0;
  std::array<char, 16> board{};
  std::array<char, 16> version{};
  std::array<char, 24> git_hash{};
  std::uint32_t chip_id = 0;      ///< DBGMCU_IDCODE.DEV_ID (RM0090, 38.6.1): 0x413 for the STM32F405
  std::uint32_t schema_hash = 0;  ///< of the parameter table (kSchemaHash)
  std::uint32_t image_size = 0;   ///< bytes from the start of the vector table, set after linking
  std::uint32_t crc = 0;          ///< CRC-32 of those bytes with this field as 0, set after linking
};
static_assert(sizeof(ImageHeader) == 80 && std::is_trivially_copyable_v<ImageHeader>);

inline constexpr std::uint32_t kImageMagic = 0x53495841;  // "AXIS"
inline constexpr std::uint16_t kImageLayout =
    2;  ///< runs after boot code, if a board has one (1: at the start of flash)
inline constexpr std::size_t kImageHeaderOffset = 512;  // the vector table of the STM32F405 has 392 bytes

/// On a board with boot code, programs begin at this offset in flash: after sector 0 of the STM32F405.
inline constexpr std::size_t kBootCodeSize = 16 * 1024;

enum class ImageState : std::uint8_t { whole, no_header, wrong_size, wrong_crc };

/// The checksum for the header of `image`, which begins with the vector table and contains a header.
inline std::uint32_t image_crc(std::span<const std::byte> image) {
  constexpr std::size_t kField = kImageHeaderOffset + offsetof(ImageHeader, crc);
  constexpr std::array<std::byte, sizeof(std::uint32_t)> kZero{};
  return Crc32().add(image.first(kField)).add(kZero).add(image.subspan(kField + kZero.size())).value();
}

/// Checks the image that begins at `memory`, which may be longer than the image; copies its header out.
inline ImageState examine_image(std::span<const std::byte> memory, ImageHeader& header) {
  if (memory.size() < kImageHeaderOffset + sizeof(ImageHeader)) return ImageState::no_header;
  std::memcpy(&header, memory.data() + kImageHeaderOffset, sizeof header);
  if (header.magic != kImageMagic || header.layout != kImageLayout || header.header_size != sizeof header)
    return ImageState::no_header;
  if (header.image_size < kImageHeaderOffset + sizeof header || header.image_size > memory.size())
    return ImageState::wrong_size;
  return image_crc(memory.first(header.image_size)) == header.crc ? ImageState::whole : ImageState::wrong_crc;
}

}  // namespace firmware
