// A firmware image of a few hundred bytes that passes all checks.
#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <string>

#include "firmware/app/image_header.hpp"

inline std::string image_text(const char* board) {
  std::string text(firmware::kImageHeaderOffset + sizeof(firmware::ImageHeader) + 100, 'x');
  firmware::ImageHeader header;
  header.magic = firmware::kImageMagic;
  header.layout = firmware::kImageLayout;
  header.header_size = sizeof header;
  header.chip_id = 0x413;
  header.image_size = static_cast<std::uint32_t>(text.size());
  std::copy_n(board, std::min<std::size_t>(std::strlen(board), 15), header.board.begin());
  std::memcpy(text.data() + firmware::kImageHeaderOffset, &header, sizeof header);
  header.crc = firmware::image_crc(std::as_bytes(std::span(text)));
  std::memcpy(text.data() + firmware::kImageHeaderOffset, &header, sizeof header);
  return text;
}

/// The same after boot code, for `axistool flash`.
inline std::string flash_text(const char* board) {
  return std::string(firmware::kBootCodeSize, 'b') + image_text(board);
}
