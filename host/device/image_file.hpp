// Firmware images on disk: what they say about themselves, and whether they may go onto a board.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "firmware/app/image_header.hpp"

namespace host {

struct ImageFile {
  std::string path;
  std::vector<std::byte> bytes;
  firmware::ImageHeader header;
  firmware::ImageState state = firmware::ImageState::no_header;
};

/// Throws Failure (bad_input) for a file that cannot be read or holds no image of ours; a damaged image is returned,
/// and its state says so.
ImageFile read_image_file(const std::string& path);

/// Throws Failure (bad_input) for an image that is damaged or for another board or chip.
void check_image_for(const ImageFile& image, const std::string& board);

/// Plain words for a state.
std::string describe(firmware::ImageState state);

}  // namespace host
