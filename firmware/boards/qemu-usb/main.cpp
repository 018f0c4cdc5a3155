// The board's application, protocol and store on the emulated processor, its reports over files to_board and
// from_board: the other end of this cable has a USB controller. Each axis has a drive, which is computed here too.
#include <algorithm>
#include <atomic>

#include "firmware/app/protocol/server.hpp"
#include "firmware/boards/image/board_scalar.hpp"
#include "firmware/boards/image/capture_memory.hpp"
#include "firmware/boards/image/fault_handler.hpp"
#include "firmware/boards/image/stack_use.hpp"
#include "firmware/boards/image/survival_record.hpp"
#include "firmware/boards/image/this_image.hpp"
#include "firmware/boards/pil/value_axis.hpp"
#include "firmware/boards/qemu-usb/memory_flash.hpp"
#include "firmware/boards/qemu-usb/report_cable.hpp"
#include "firmware/boards/qemu-usb/rigid_drive.hpp"
#include "hal/board.hpp"
#include "hal/cortex_m/control_shut_out.hpp"
#include "hal/cortex_m/registers.hpp"
#include "hal/cortex_m/wait_for_interrupt.hpp"
#include "hal/qemu/host_stream.hpp"

namespace firmware::boards {

namespace {

constexpr std::uint32_t kClock_Hz = 168'000'000;  // QEMU gives the chip its 168 MHz

[[gnu::section(".noinit")]] MemoryFlash::Cells flash_cells;
hal::qemu::HostStream stream;
std::atomic<std::uint32_t> control_time_us = 0;  // at the control interrupt's last start

// Two emulators have two times, and either may pass the slower: the board's goes on only as far as the computer's has,
// and as long as a computer that is the quicker may have to wait for it.
std::atomic<std::uint32_t> computer_time_us = 0;
constexpr std::uint32_t kMostBehind_us = 20'000;

class EmulatedBoard {
 public:
  static constexpr std::size_t kAxes = hal::kAxisCount;
  using AxisType = ValueAxis;

  using ControlShutOut = hal::cortex_m::ControlShutOut;

  /// No button is wired.
  struct Stop {
    bool is_pressed() const { return false; }
  };

  struct Supply {
    bool is_low() const { return false; }
  };

  /// A control period is its step: nothing here is quicker.
  struct Clock {
    std::uint32_t now_us() const { return control_time_us; }
  };

  ValueAxis& axis(std::size_t index) { return axes_[index]; }
  Stop& emergency_stop() { return stop_; }
  Supply& supply() { return supply_; }
  Clock& clock() { return clock_; }
  BoardEnd<hal::qemu::HostStream>& usb() { return usb_; }
  MemoryFlash& parameter_flash() { return flash_; }
  TriggeredState& capture_state() { return boards::capture_state(); }
  std::span<std::uint16_t> capture_rows() { return boards::capture_rows(); }

  void set_control_rate(std::uint32_t rate_Hz) {
    period_us_ = 1'000'000 / rate_Hz;
    hal::cortex_m::sys_tick().RVR = kClock_Hz / rate_Hz - 1;
  }
  void begin_stall() {}
  void end_stall() {}
  void restart() { reset_processor(); }

  std::uint32_t period_us() const { return period_us_; }
  /// Whether the computer's time has gone on by another period.
  bool has_time() const { return computer_time_us - control_time_us >= period_us_; }
  void take_computer_time() {
    const std::uint32_t now_us = control_time_us;
    computer_time_us = now_us + std::min(computer_time_us - now_us + usb_.take_passed_us(), kMostBehind_us);
  }

  /// The drives' motion in the period that has passed, and what is read of it.
  void advance_drives() {
    for (std::size_t i = 0; i < kAxes; ++i) {
      ValueAxis& axis = axes_[i];
      drives_[i].advance(static_cast<float>(period_us_) * 1e-6F, axis.dac().code, axis.drive_enable().on);
      axis.encoder().reading = {drives_[i].counts(), true};
      axis.tachometer().reading = {drives_[i].tachometer_code(), true};
    }
  }

 private:
  std::array<ValueAxis, kAxes> axes_;
  std::array<RigidDrive, kAxes> drives_;
  Stop stop_;
  Supply supply_;
  Clock clock_;
  BoardEnd<hal::qemu::HostStream> usb_{stream};
  MemoryFlash flash_{flash_cells};
  std::uint32_t period_us_ = 1000;
};
static_assert(hal::Board<EmulatedBoard>);

using Application = BoardApplication<BoardScalar, EmulatedBoard>;

EmulatedBoard board;
Application application(board);

}  // namespace

/// There is no converter and no enable line here.
void make_outputs_safe() noexcept {}

}  // namespace firmware::boards

extern "C" void control_interrupt() {
  using namespace firmware::boards;
  if (!board.has_time()) return;
  control_time_us = control_time_us + board.period_us();
  board.advance_drives();
  application.control_period();
}

extern "C" [[noreturn]] void run_board() {
  using namespace firmware::boards;
  const LastRun last_run = take_over_survival_record(ResetCause::unknown);
  arm_fault_detection();
  if (!stream.open("to_board", "link.in")) hal::qemu::exit_emulator(1);
  application.start();
  const firmware::BootFacts boot{static_cast<std::uint8_t>(last_run.cause), static_cast<std::uint16_t>(last_run.resets),
                                 true};
  firmware::ProtocolServer<Application> server(application, this_image(), boot);
  using hal::cortex_m::SysTick;
  hal::cortex_m::set_exception_priority(hal::cortex_m::kSysTickException, 2);
  hal::cortex_m::sys_tick().CSR = SysTick::kEnable | SysTick::kInterrupt | SysTick::kProcessorClock;
  board.usb().say_hello();
  firmware::ProgramUse use{stack_used_bytes(), stack_size_bytes()};
  constexpr unsigned kRestsPerLook = 100;  // at the whole stack, which takes long
  for (unsigned rests = 1;; ++rests) {
    constexpr int kRounds = 4;
    for (int rounds = kRounds; rounds > 0; --rounds) {
      if (board.usb().poll()) rounds = kRounds;
      board.take_computer_time();
      server.poll(board.usb(), use);
      stream.flush();
    }
    hal::cortex_m::wait_for_interrupt();  // the computer has better to do than to emulate a processor that waits
    if (rests % kRestsPerLook == 0) use.stack_used = stack_used_bytes();
  }
}
