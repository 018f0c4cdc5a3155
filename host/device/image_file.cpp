#include "host/device/image_file.hpp"

#include <fmt/format.h>

#include "host/exit_codes.hpp"
#include "host/read_file.hpp"

namespace host {

namespace {
constexpr std::uint32_t kChipOfAxisBoard = 0x413;  // STM32F405: RM0090, 38.6.1
}

ImageFile read_image_file(const std::string& path) { return parse_image_file(read_file(path), path); }

ImageFile parse_image_file(std::string_view text, const std::string& path) {
  ImageFile image;
  image.path = path;
  const auto bytes = std::as_bytes(std::span(text));
  image.bytes.assign(bytes.begin(), bytes.end());
  for (const std::size_t begin : {firmware::kBootCodeSize, std::size_t{0}}) {
    if (begin >= image.bytes.size()) continue;
    image.begin = begin;
    image.state = firmware::examine_image(std::span(image.bytes).subspan(begin), image.header);
    if (image.state != firmware::ImageState::no_header) break;
  }
  if (image.state == firmware::ImageState::no_header)
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: no image header at offset {} or {}: give the .bin file that `make firmware` of this "
                    "version leaves in build/firmware/images",
                    path, firmware::kImageHeaderOffset, firmware::kBootCodeSize + firmware::kImageHeaderOffset));
  return image;
}

void check_image_for(const ImageFile& image, const std::string& board) {
  if (image.state != firmware::ImageState::whole)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: {}; build or copy it again", image.path, describe(image.state)));
  const std::string built_for = image.header.board.data();
  if (built_for != board)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: the image is for board {}, not {}", image.path, built_for, board));
  if (image.header.chip_id != kChipOfAxisBoard)
    throw Failure(ExitCode::bad_input, fmt::format("{}: the image is for chip {:#05x}, not for the STM32F405 ({:#05x})",
                                                   image.path, image.header.chip_id, kChipOfAxisBoard));
}

std::string describe(firmware::ImageState state) {
  switch (state) {
    case firmware::ImageState::whole:
      return "whole";
    case firmware::ImageState::no_header:
      return "no image header";
    case firmware::ImageState::wrong_size:
      return "shorter than its header says, or its size was never filled in";
    case firmware::ImageState::wrong_crc:
      break;
  }
  return "its checksum does not match: damaged";
}

}  // namespace host
