// A program behind boot code, AXIS_IMAGE_NUMBER, which takes another one as an update. The emulator has put the bytes
// of the other program into memory.
#include "firmware/app/update/image_update.hpp"
#include "firmware/boards/image/fault_handler.hpp"
#include "firmware/boards/image/survival_record.hpp"
#include "firmware/boards/image/text_writer.hpp"
#include "firmware/boards/image/this_image.hpp"
#include "hal/qemu/semihosting.hpp"
#include "hal/serial_queue.hpp"
#include "tests/target/images/update/boot_board.hpp"

namespace firmware::boards {

namespace {

constexpr std::uintptr_t kOtherImage = 0x200000;

hal::mps2::UartPort uart;
hal::mps2::Watchdog watchdog;
hal::SerialQueue<hal::mps2::UartPort, 256> serial(uart);
CodeMemoryFlash flash;

const auto kAtOnce = [](auto write) { return write(); };

bool take_other(ImageUpdate<CodeMemoryFlash>& update) {
  const auto* const bytes = reinterpret_cast<const std::byte*>(kOtherImage);
  ImageHeader header;
  std::memcpy(&header, bytes + kImageHeaderOffset, sizeof header);
  ImageRefusal refusal = ImageRefusal::none;
  const BeginUpdateRequest announced{header.image_size, header.crc, header.chip_id, header.layout, 0, header.board};
  if (update.begin(announced, refusal, kAtOnce) != UpdateResult::ok) return false;
  for (std::size_t offset = 0; offset < header.image_size; offset += kUpdateBlock) {
    UpdateBlockRequest block;
    block.offset = static_cast<std::uint32_t>(offset);
    std::memcpy(block.bytes.data(), bytes + offset, kUpdateBlock);
    if (update.take(block, kAtOnce) != UpdateResult::ok) return false;
    watchdog.feed();
  }
  return update.finish(refusal, kAtOnce) == UpdateResult::ok;
}

/// State of a newly flashed chip: blank except for the program.
void blank() {
  const std::size_t marks = flash.sector_size() - sizeof(SlotMarks);
  std::memset(reinterpret_cast<std::byte*>(CodeMemoryFlash::kFirstAddress) + marks, 0xFF, sizeof(SlotMarks));
  flash.erase(1);
  flash.erase(2);
}

}  // namespace

void make_outputs_safe() noexcept {}  // there are none here

}  // namespace firmware::boards

extern "C" void watchdog_warning() {
  for (;;) asm volatile("" ::: "memory");
}

extern "C" void control_interrupt() {}

/// 'b' blanks the flash except for the program, 'u' takes the other image, 'c' confirms this one, 'r' resets, 'h'
/// hangs, 'q' ends the emulator.
extern "C" [[noreturn]] void run_board() {
  using namespace firmware::boards;
  take_over_survival_record(ResetCause::unknown);
  arm_fault_detection();
  uart.start();
  firmware::ImageUpdate<CodeMemoryFlash> update(flash, this_image());
  TextWriter out(serial);
  out << "image " << std::uint32_t{AXIS_IMAGE_NUMBER} << (update.is_on_trial() ? " on trial\n" : " runs\n");
  for (;;) {
    watchdog.feed();
    serial.poll();
    std::byte letter{};
    if (!serial.is_empty() || !serial.receive(letter)) continue;
    switch (static_cast<char>(letter)) {
      case 'b':
        blank();
        out << "blank\n";
        break;
      case 'u':
        out << (take_other(update) ? "taken\n" : "not taken\n");
        break;
      case 'c':
        out << (update.confirm(kAtOnce) == firmware::UpdateResult::ok ? "confirmed\n" : "not confirmed\n");
        break;
      case 'r':
        reset_processor();
      case 'h':
        for (;;) asm volatile("" ::: "memory");
      case 'q':
        hal::qemu::exit_emulator(0);
      default:
        break;
    }
  }
}
