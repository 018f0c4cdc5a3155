// Any bytes as a board's program flash: the boot code ends, starts only complete images, and decides the same at the
// next reset; the running program reports the slots' states.
#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "firmware/app/update/boot_choice.hpp"
#include "firmware/app/update/image_update.hpp"
#include "hal/pc/simulated_flash.hpp"

namespace {

constexpr std::size_t kSector = 1024;

/// The lowest bits of `truth` select repairs of a sector: a valid image, a valid number, and marks.
void mend(std::vector<std::byte>& sector, std::uint8_t truth) {
  firmware::ImageHeader header;
  std::byte* const place = sector.data() + firmware::kImageHeaderOffset;
  std::byte* const behind = sector.data() + kSector - sizeof(firmware::SlotMarks);
  firmware::SlotMarks marks;
  std::memcpy(&header, place, sizeof header);
  std::memcpy(&marks, behind, sizeof marks);
  if ((truth & 1) != 0) {
    header.magic = firmware::kImageMagic;
    header.layout = firmware::kImageLayout;
    header.header_size = sizeof header;
    header.image_size = 700 + header.image_size % 200;
    std::memcpy(place, &header, sizeof header);
    header.crc = firmware::image_crc(std::span<const std::byte>(sector).first(header.image_size));
    std::memcpy(place, &header, sizeof header);
  }
  if ((truth & 2) != 0) marks.inverse = ~marks.number;
  if ((truth & 4) != 0) marks.complete = firmware::kValidMark;
  if ((truth & 8) != 0) marks.tried = firmware::kNotProgrammed;
  if ((truth & 16) != 0) marks.healthy = firmware::kValidMark;
  if ((truth & 32) != 0) marks.number = marks.inverse = firmware::kNotProgrammed;
  std::memcpy(behind, &marks, sizeof marks);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hal::pc::SimulatedFlash flash(3, kSector, 4);
  for (auto& sector : flash.contents()) {
    if (size == 0) break;
    const std::uint8_t truth = *data++;
    const std::size_t taken = std::min(--size, kSector);
    std::memcpy(sector.data(), data, taken);
    data += taken;
    size -= taken;
    mend(sector, truth);
  }
  firmware::ImageSlots slots(flash);
  const bool starts = firmware::BootChoice(flash).prepare() != firmware::BootResult::nothing;
  if (starts != slots.is_whole(0)) std::abort();
  const firmware::ImageHeader own = slots.header(0);
  firmware::ImageUpdate update(flash, own);
  update.is_on_trial();
  for (const std::size_t slot : {1, 2}) slots.state(slot);
  const auto at_once = [](auto write) { return write(); };
  if (starts) update.confirm(at_once);
  const auto before = flash.contents();
  if ((firmware::BootChoice(flash).prepare() != firmware::BootResult::nothing) != starts) std::abort();
  if (starts && !slots.is_whole(0)) std::abort();
  return 0;
}
