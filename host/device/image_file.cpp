#include "host/device/image_file.hpp"

#include <fmt/format.h>

#include "host/exit_codes.hpp"
#include "host/read_file.hpp"

namespace host {

namespace {
constexpr std::uint32_t kChipOfAxisBoard = 0x413;  // STM32F405: RM0090, 38.6.1
}

ImageFile read_image_file(const std::string& path) {
  ImageFile image;
  image.path = path;
  const std::string text = read_file(path);
  const auto bytes = std::as_bytes(std::span(text));
  image.bytes.assign(bytes.begin(), bytes.end());
  image.state = firmware::examine_image(image.bytes, image.header);
  if (image.state == firmware::ImageState::no_header)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: no image header at offset {}: give the .bin file that `make firmware` leaves in "
                              "build/firmware/images",
                              path, firmware::kImageHeaderOffset));
  return image;
}

void check_image_for(const ImageFile& image, const std::string& board) {
  if (image.state != firmware::ImageState::whole)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: {}; build or copy it again", image.path, describe(image.state)));
  const std::string built_for = image.header.board.data();
  if (built_for != board)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: the image is for board {}, not {}; --board says which board is connected",
                              image.path, built_for, board));
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
