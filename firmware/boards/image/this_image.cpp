#include "firmware/boards/image/this_image.hpp"

#include <build_version.hpp>

#include "firmware/app/parameters/parameter_table.hpp"

extern "C" {
extern const std::byte _image_start[];  // NOLINT: linker symbols
extern const std::byte _image_limit[];
}

namespace firmware::boards {

namespace {

template <std::size_t size, std::size_t text_size>
constexpr std::array<char, size> padded(const char (&text)[text_size]) {
  static_assert(text_size <= size);
  std::array<char, size> result{};
  for (std::size_t i = 0; i < text_size; ++i) result[i] = text[i];
  return result;
}

[[gnu::section(".image_header"), gnu::used]] constinit const ImageHeader header{
    kImageMagic,
    kImageLayout,
    sizeof(ImageHeader),
    padded<16>(AXIS_BOARD_NAME),
    padded<16>(AXIS_VERSION),
    padded<24>(AXIS_GIT_HASH),
    AXIS_CHIP_ID,
    kSchemaHash,
    0,
    0,
};

}  // namespace

const ImageHeader& this_image() {
  const ImageHeader* in_flash = &header;
  asm("" : "+r"(in_flash));  // the linked bytes differ from what the compiler sees: size and CRC come later
  return *in_flash;
}

ImageState verify_this_image() {
  const std::byte* start = _image_start;
  asm("" : "+r"(start));  // flash may begin at address 0, which is not a null pointer here
  ImageHeader read_back;
  return examine_image({start, reinterpret_cast<std::size_t>(_image_limit)}, read_back);
}

}  // namespace firmware::boards
