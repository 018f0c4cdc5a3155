// Build step: completes the header of a linked image with its size and checksum.
//   stamp_image IMAGE.bin HEADER-OUT.bin        writes the completed header, for objcopy to put in place
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "firmware/app/image_header.hpp"

namespace {

int complain(const std::string& message) {
  std::fprintf(stderr, "stamp_image: %s\n", message.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return complain("usage: stamp_image IMAGE.bin HEADER-OUT.bin");
  std::ifstream in(argv[1], std::ios::binary);
  std::vector<char> image(std::istreambuf_iterator<char>(in), {});
  firmware::ImageHeader header;
  if (!in.good() && image.empty()) return complain(std::string(argv[1]) + ": cannot be read");
  if (image.size() < firmware::kImageHeaderOffset + sizeof header)
    return complain(std::string(argv[1]) + ": too short to hold an image header");
  char* place = image.data() + firmware::kImageHeaderOffset;
  std::memcpy(&header, place, sizeof header);
  if (header.magic != firmware::kImageMagic)
    return complain(std::string(argv[1]) + ": has no image header at offset 512; was this_image.cpp linked?");
  header.image_size = static_cast<std::uint32_t>(image.size());
  header.crc = 0;
  std::memcpy(place, &header, sizeof header);
  header.crc = firmware::image_crc(std::as_bytes(std::span(image)));
  std::ofstream out(argv[2], std::ios::binary);
  out.write(reinterpret_cast<const char*>(&header), sizeof header);
  out.close();
  return out.good() ? 0 : complain(std::string(argv[2]) + ": cannot be written");
}
