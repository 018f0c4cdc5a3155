// Makes images of programs, complete or not, for boards that exist only in these tests.
#pragma once

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

#include "firmware/app/image_header.hpp"
#include "firmware/app/protocol/update_messages.hpp"

namespace firmware_test {

using Bytes = std::vector<std::byte>;

/// Writes at once: the simulated flash stalls nothing else.
inline constexpr auto kAtOnce = [](auto write) { return write(); };

/// An image of `size` bytes; `seed` decides those outside the header.
inline Bytes made_image(std::string_view version, unsigned seed, std::size_t size = 900,
                        std::string_view board = "simulated") {
  Bytes image(size);
  for (std::size_t i = 0; i < size; ++i) image[i] = static_cast<std::byte>((i * 7 + seed * 31 + i / 5) & 0xFF);
  firmware::ImageHeader header;
  header.magic = firmware::kImageMagic;
  header.layout = firmware::kImageLayout;
  header.header_size = sizeof header;
  header.chip_id = 0x413;
  header.image_size = static_cast<std::uint32_t>(size);
  std::copy_n(board.begin(), std::min<std::size_t>(board.size(), 15), header.board.begin());
  std::copy_n(version.begin(), std::min<std::size_t>(version.size(), 15), header.version.begin());
  std::memcpy(image.data() + firmware::kImageHeaderOffset, &header, sizeof header);
  header.crc = firmware::image_crc(image);
  std::memcpy(image.data() + firmware::kImageHeaderOffset, &header, sizeof header);
  return image;
}

inline firmware::ImageHeader header_of(const Bytes& image) {
  firmware::ImageHeader header;
  std::memcpy(&header, image.data() + firmware::kImageHeaderOffset, sizeof header);
  return header;
}

/// The host's announcement of the image.
inline firmware::BeginUpdateRequest announcement_of(const Bytes& image) {
  const firmware::ImageHeader header = header_of(image);
  return {header.image_size, header.crc, header.chip_id, header.layout, 0, header.board};
}

/// The block of the image that begins at `offset`.
inline firmware::UpdateBlockRequest block_of(const Bytes& image, std::size_t offset) {
  firmware::UpdateBlockRequest block;
  block.offset = static_cast<std::uint32_t>(offset);
  block.bytes.fill(std::byte{0xFF});
  std::copy_n(image.begin() + static_cast<std::ptrdiff_t>(offset), std::min(block.bytes.size(), image.size() - offset),
              block.bytes.begin());
  return block;
}

}  // namespace firmware_test
