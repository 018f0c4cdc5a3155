#include "host/simulated_board/simulated_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "firmware/app/image_header.hpp"
#include "firmware/app/parameters/parameter_table.hpp"
#include "host/exit_codes.hpp"

namespace host {

std::vector<std::byte> simulated_image(std::string_view version) {
  constexpr std::size_t kSize = 4096;
  firmware::ImageHeader header;
  if (version.empty() || version.size() >= header.version.size())
    throw Failure(ExitCode::usage,
                  fmt::format("version '{}': 1 to {} characters are possible", version, header.version.size() - 1));
  header.magic = firmware::kImageMagic;
  header.layout = firmware::kImageLayout;
  header.header_size = sizeof header;
  header.chip_id = 0x413;  // the same as the axis board's: RM0090, 38.6.1
  header.schema_hash = firmware::kSchemaHash;
  header.image_size = kSize;
  std::ranges::copy(std::string_view("simulated"), header.board.begin());
  std::ranges::copy(version, header.version.begin());
  std::vector<std::byte> image(kSize);
  const auto put_header = [&] { std::memcpy(image.data() + firmware::kImageHeaderOffset, &header, sizeof header); };
  put_header();
  header.crc = firmware::image_crc(image);
  put_header();
  return image;
}

}  // namespace host
