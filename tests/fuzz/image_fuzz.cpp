// Any bytes as a firmware image: it is refused with a reason, or named whole and lies within the file.
#include <cstdlib>
#include <string_view>

#include "host/device/image_file.hpp"
#include "host/exit_codes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto file = host::parse_image_file({reinterpret_cast<const char*>(data), size}, "fuzz.bin");
    const auto image = file.image();
    const bool is_inside = file.begin + image.size() <= file.bytes.size() && image.size() <= file.header.image_size;
    if (!is_inside) std::abort();
    if (file.state == firmware::ImageState::whole && image.size() != file.header.image_size) std::abort();
    host::check_image_for(file, "axis-f405");
  } catch (const host::Failure&) {
  }
  return 0;
}
