// The board as QEMU's mps2-an386 has it: start-up, faults and supervision of the axis board, with a watchdog that
// resets.
#include <array>

#include "firmware/app/liveness.hpp"
#include "firmware/boards/image/boot_report.hpp"
#include "firmware/boards/image/fault_handler.hpp"
#include "hal/cortex_m/registers.hpp"
#include "hal/mps2/cmsdk.hpp"
#include "hal/qemu/semihosting.hpp"
#include "hal/serial_queue.hpp"

namespace firmware::boards {

namespace {

constexpr std::uint32_t kClock_Hz = 25'000'000;  // AN386: processor and watchdog
constexpr std::uint32_t kControlRate_Hz = 1000;
constexpr std::uint32_t kTicksPerPeriod = kClock_Hz / kControlRate_Hz;
constexpr std::uint32_t kWatchdogTicks = kClock_Hz / 20;  // resets after twice 50 ms

constinit Liveness liveness;
hal::mps2::UartPort uart;
hal::mps2::Watchdog watchdog;
volatile bool control_runs = true;
volatile std::uint32_t periods_passed = 0;

/// The emulated UART sends at once; this line takes as long for a character as one at 115200 baud does.
class SlowLine {
 public:
  bool offer(std::byte byte) {
    const std::uint32_t now = ticks();
    if (now - sent_at_ < kCharacterTicks) return false;
    sent_at_ = now;
    return uart.offer(byte);
  }
  bool receive(std::byte& byte) { return uart.receive(byte); }

 private:
  static constexpr std::uint32_t kCharacterTicks = kClock_Hz / 11520;

  /// Processor clocks: whole control periods, and how far SysTick has counted down in this one.
  static std::uint32_t ticks() {
    for (;;) {
      const std::uint32_t periods = periods_passed, left = hal::cortex_m::sys_tick().CVR;
      if (periods == periods_passed) return periods * kTicksPerPeriod + (kTicksPerPeriod - 1 - left);
    }
  }

  std::uint32_t sent_at_ = 0;
};
SlowLine line;
hal::SerialQueue<SlowLine, 2048> serial(line);

void start_control_interrupt() {
  using hal::cortex_m::SysTick;
  SysTick& tick = hal::cortex_m::sys_tick();
  tick.RVR = kTicksPerPeriod - 1;
  tick.CVR = 0;
  tick.CSR = SysTick::kEnable | SysTick::kInterrupt | SysTick::kProcessorClock;
}

/// 'c' stops the control interrupt's work, 'p' stops the supervisor, 'r' repeats the boot report, 'q' ends the
/// emulator.
[[noreturn]] void serve(const LastRun& last_run) {
  TextWriter out(serial);
  bool supervisor_runs = true;
  std::uint32_t feedings = 0;
  for (;;) {
    if (supervisor_runs) liveness.supervisor_ran();
    if (liveness.may_feed()) {
      watchdog.feed();
      if (++feedings % 20 == 0 && feedings <= 100) out << "fed " << feedings << "\n";
    }
    serial.poll();
    std::byte letter{};
    if (!serial.is_empty() || !serial.receive(letter)) continue;
    if (letter == std::byte{'r'}) report_boot(serial, last_run, verify_this_image());
    if (letter == std::byte{'c'}) control_runs = false;
    if (letter == std::byte{'p'}) supervisor_runs = false;
    if (letter == std::byte{'q'}) hal::qemu::exit_emulator(0);
  }
}

}  // namespace

void make_outputs_safe() noexcept {}  // there are none here

}  // namespace firmware::boards

/// The watchdog's first time-out. Nothing may save the board now: with interrupts shut out, its second one resets.
extern "C" void watchdog_warning() {
  firmware::boards::make_outputs_safe();
  for (;;) asm volatile("" ::: "memory");
}

extern "C" void control_interrupt() {
  using namespace firmware::boards;
  periods_passed = periods_passed + 1;
  if (!control_runs) return;
  liveness.control_ran();
  survival_record().running.control_periods = liveness.control_periods();
  survival_record().running.supervisor_rounds = liveness.supervisor_rounds();
}

extern "C" [[noreturn]] void run_board() {
  using namespace firmware::boards;
  const LastRun last_run = take_over_survival_record(ResetCause::unknown);
  arm_fault_detection();
  uart.start();
  report_boot(serial, last_run, verify_this_image());
  TextWriter(serial) << "ready\n";
  survival_record().watchdog_armed = 1;
  watchdog.start(kWatchdogTicks);
  start_control_interrupt();
  serve(last_run);
}
