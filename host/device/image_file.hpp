// Firmware images on disk: their header, and whether a board accepts them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/app/image_header.hpp"

namespace host {

/// A file from `make firmware`: the image, for a board with boot code after that code.
struct ImageFile {
  std::string path;
  std::vector<std::byte> bytes;  ///< all of the file
  std::size_t begin = 0;         ///< offset of the image in the file: after the boot code; 0 without boot code
  firmware::ImageHeader header;
  firmware::ImageState state = firmware::ImageState::no_header;

  /// The image alone, without boot code and trailing bytes.
  std::span<const std::byte> image() const {
    const auto behind_boot = std::span(bytes).subspan(begin);
    return behind_boot.first(std::min<std::size_t>(header.image_size, behind_boot.size()));
  }
};

/// Throws Failure (bad_input) for a file that cannot be read or contains no image of this project. A damaged image is
/// returned; its state says how it is damaged.
ImageFile read_image_file(const std::string& path);
/// The same from bytes in memory; `path` is for messages.
ImageFile parse_image_file(std::string_view bytes, const std::string& path);

/// Throws Failure (bad_input) for an image that is damaged or for another board or chip.
void check_image_for(const ImageFile& image, const std::string& board);

/// A state in words.
std::string describe(firmware::ImageState state);

}  // namespace host
