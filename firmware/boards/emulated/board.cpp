#include "firmware/boards/emulated/board.hpp"

#include "hal/cortex_m/wait_for_interrupt.hpp"

namespace firmware::boards {

extern Board board;  // of program/control.cpp

namespace {

using hal::cortex_m::SysTick;

// Lines of the interrupt controller that no device of the machine uses.
constexpr std::uint32_t kControlLine = 29, kConverterLine = 30, kUsbLine = 31;

[[gnu::section(".noinit")]] MemoryFlash::Cells flash_cells;

void ask_for_interrupt(std::uint32_t line) { hal::cortex_m::interrupt_controller().ISPR[line / 32] = 1u << line % 32; }

}  // namespace

Board::Board() : flash_(flash_cells) {}

bool BenchLine::receive(std::byte& byte) {
  if (!uart_.receive(byte)) return false;
  const char letter = static_cast<char>(byte);
  if (letter < 'A' || letter > 'Z') return true;
  board.obey(letter);
  return false;
}

bool Board::start() {
  line_.start();
  SysTick& tick = hal::cortex_m::sys_tick();
  tick.RVR = processor_Hz() / (1'000'000 / period_us_) - 1;
  tick.CVR = 0;
  tick.CSR = SysTick::kEnable | SysTick::kInterrupt | SysTick::kProcessorClock;
  return true;
}

void Board::start_control() {
  constexpr std::uint8_t kPriority = 1;
  hal::cortex_m::enable_interrupt(kConverterLine, kPriority);
  hal::cortex_m::enable_interrupt(kControlLine, kPriority);
}

bool Board::start_usb() {
  constexpr std::uint8_t kPriority = 6;
  if (!usb_.start()) return false;
  hal::cortex_m::enable_interrupt(kUsbLine, kPriority);
  return true;
}

std::uint32_t Board::ticks() {
  for (;;) {
    const SysTick& tick = hal::cortex_m::sys_tick();
    const std::uint32_t passed = board.passed_ticks_, into = tick.RVR - tick.CVR;
    if (passed == board.passed_ticks_) return passed + into;
  }
}

void Board::period_ends() {
  passed_ticks_ = passed_ticks_ + hal::cortex_m::sys_tick().RVR + 1;
  if (usb_.has_frames()) ask_for_interrupt(kUsbLine);
  if (knows_computer_ && computer_time_us_ - clock_.us < period_us_) {
    watchdog_.feed();  // it uses the board's clock, which stands still
    return;
  }
  if (!timer_runs_) return;
  if (has_overrun_) {
    ask_for_interrupt(kConverterLine);
    return;
  }
  ask_for_interrupt(kControlLine);
}

/// The period begins here, because a late emulator may end two of the timer's periods in a row.
void Board::acknowledge_control() {
  clock_.us = clock_.us + period_us_;
  for (std::size_t i = 0; i < kAxes; ++i) {
    ValueAxis& axis = axes_[i];
    drives_[i].advance(static_cast<float>(period_us_) * 1e-6F, axis.dac().code, axis.drive_enable().on);
    axis.encoder().reading = {drives_[i].counts(), true};
    axis.tachometer().reading = {drives_[i].tachometer_code(), true};
  }
}

void Board::take_computer_time() {
  const std::uint32_t passed_us = usb_.take_passed_us();
  if (passed_us == 0) return;
  const std::uint32_t now_us = clock_.us;
  const std::uint32_t ahead_us = knows_computer_ ? computer_time_us_ - now_us : 0;
  computer_time_us_ = now_us + std::min(ahead_us + passed_us, kMostBehind_us);
  knows_computer_ = true;
}

/// Waits for an interrupt: this saves the computer's time, because a waiting processor need not be emulated.
void Board::watch(bool) {
  constexpr unsigned kRounds = 4;
  while (!background_runs_) continue;
  take_computer_time();
  if (usb_.quiet_rounds() % kRounds == kRounds - 1) hal::cortex_m::wait_for_interrupt();
}

void Board::report(TextWriter<Serial>& out) const {
  out << "bench: fed " << feedings_ << ", beats " << beats_ << ", scans restarted " << overruns_ << ", lamps " << lamps_
      << "\nready\n";
}

void Board::obey(char letter) {
  switch (letter) {
    case 'B':
      provoke_bus_fault();
      break;
    case 'N':
      provoke_null_read();
      break;
    case 'D':
      provoke_division_by_zero();
      break;
    case 'S':
      provoke_stack_overflow();
      break;
    case 'I':
      provoke_unexpected_interrupt();
      break;
    case 'J':
      start_again_like_a_boot_rom();
    case 'R':
      reset_processor();
    case 'T':
      timer_runs_ = false;
      break;
    case 'H':
      background_runs_ = false;
      break;
    case 'O':
      has_overrun_ = true;
      break;
    case 'W':
      drives_[1].become_heavy_and_late();
      break;
    case 'Q':
      hal::qemu::exit_emulator(0);
    default:
      break;
  }
}

void make_outputs_safe() noexcept {}  // this board has no outputs

}  // namespace firmware::boards

extern "C" void period_ends() { firmware::boards::board.period_ends(); }

/// The watchdog's first time-out. With interrupts disabled, nothing feeds it, and its second time-out resets the board.
extern "C" void watchdog_warning() {
  firmware::boards::make_outputs_safe();
  for (;;) asm volatile("" ::: "memory");
}
