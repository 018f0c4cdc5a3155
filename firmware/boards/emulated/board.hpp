// The board in QEMU's mps2-an386, which has processor, FPU, MPU, interrupt controller, a serial port, and a watchdog
// that resets. This file adds what that machine lacks: timer, converter and USB controller with their interrupts, the
// drives, and a bench that causes faults on request.
#pragma once

#include <algorithm>
#include <array>

#include "firmware/boards/emulated/memory_flash.hpp"
#include "firmware/boards/emulated/provoke.hpp"
#include "firmware/boards/emulated/report_cable.hpp"
#include "firmware/boards/emulated/rigid_drive.hpp"
#include "firmware/boards/image/capture_memory.hpp"
#include "firmware/boards/image/fault_handler.hpp"
#include "firmware/boards/image/survival_record.hpp"
#include "firmware/boards/image/text_writer.hpp"
#include "firmware/boards/pil/value_axis.hpp"
#include "hal/board.hpp"
#include "hal/cortex_m/control_shut_out.hpp"
#include "hal/cortex_m/registers.hpp"
#include "hal/mps2/cmsdk.hpp"
#include "hal/qemu/host_stream.hpp"
#include "hal/serial_queue.hpp"

namespace firmware::boards {

/// The emulated UART sends at once; this line needs as long for a character as one at 115200 baud. Capital letters are
/// not for the program: they are commands to the bench.
class BenchLine {
 public:
  /// Processor clocks since start.
  using Ticks = std::uint32_t (*)();
  BenchLine(Ticks ticks, std::uint32_t character_ticks) : ticks_(ticks), character_ticks_(character_ticks) {}

  void start() { uart_.start(); }
  bool offer(std::byte byte) {
    const std::uint32_t now = ticks_();
    if (now - sent_at_ < character_ticks_) return false;
    sent_at_ = now;
    return uart_.offer(byte);
  }
  bool receive(std::byte& byte);

 private:
  hal::mps2::UartPort uart_;
  Ticks ticks_;
  std::uint32_t character_ticks_, sent_at_ = 0;
};

/// USB through report_cable.hpp. Its interrupt reads bytes; the background handles them.
class CableUsb {
 public:
  bool start() {
    if (!stream_.open("to_board", "link.in")) return false;
    is_open_ = true;
    cable_.say_hello();
    stream_.flush();
    return true;
  }
  /// A full-speed bus has a frame each millisecond; its controller interrupts then.
  bool has_frames() const { return is_open_; }
  void handle_interrupt() {
    if (is_open_) stream_.fetch();
  }
  /// Number of rounds of the background without a byte.
  unsigned quiet_rounds() const { return quiet_rounds_; }
  void poll() {
    if (!is_open_) return;
    quiet_rounds_ = cable_.poll() ? 0 : quiet_rounds_ + 1;
    stream_.flush();
  }
  std::uint32_t take_passed_us() { return cable_.take_passed_us(); }

  bool send(const hal::HidReport& report) { return cable_.send(report); }
  bool receive(hal::HidReport& report) { return cable_.receive(report); }
  bool is_configured() const { return cable_.is_configured(); }

 private:
  hal::qemu::HostStream stream_;
  BoardEnd<hal::qemu::HostStream> cable_{stream_};
  bool is_open_ = false;
  unsigned quiet_rounds_ = 0;
};
static_assert(hal::UsbHid<CableUsb>);

class Board {
 public:
  static constexpr std::size_t kAxes = hal::kAxisCount;
  static constexpr bool kIsSimulated = true;
  using AxisType = ValueAxis;
  using ControlShutOut = hal::cortex_m::ControlShutOut;
  using Serial = hal::SerialQueue<BenchLine, 2048>;

  /// No stop button is wired.
  struct Stop {
    bool is_pressed() const { return false; }
  };
  struct Supply {
    bool is_low() const { return false; }
  };
  /// Its resolution is a control period; nothing here needs a finer one.
  struct Clock {
    volatile std::uint32_t us = 0;  ///< at the control interrupt's last start
    std::uint32_t now_us() const { return us; }
  };

  Board();
  bool start();
  void start_watchdogs() { watchdog_.start(kWatchdogTicks); }
  void feed_watchdog() {
    watchdog_.feed();
    ++feedings_;
  }
  void set_control_rate(std::uint32_t rate_Hz) {
    period_us_ = 1'000'000 / rate_Hz;
    hal::cortex_m::sys_tick().RVR = processor_Hz() / rate_Hz - 1;
  }
  void start_control();
  bool start_usb();
  void acknowledge_control();
  void control_has_run(bool all_is_alive) { beats_ = beats_ + (all_is_alive ? 1 : 0); }
  void recover_conversions() {
    overruns_ = overruns_ + 1;
    has_overrun_ = false;
  }

  void watch(bool outputs_off);
  bool lacks_brown_out_reset() const { return false; }
  void report(TextWriter<Serial>& out) const;

  ValueAxis& axis(std::size_t index) { return axes_[index]; }
  Stop& emergency_stop() { return stop_; }
  Supply& supply() { return supply_; }
  Clock& clock() { return clock_; }
  static constexpr std::uint32_t processor_Hz() { return kClock_Hz; }
  Serial& serial() { return serial_; }
  CableUsb& usb() { return usb_; }
  MemoryFlash& parameter_flash() { return flash_; }
  TriggeredState& capture_state() { return boards::capture_state(); }
  std::span<std::uint16_t> capture_rows() { return boards::capture_rows(); }

  void begin_stall() {}
  void end_stall() {}
  void restart() { reset_processor(); }
  void show(bool running, bool fault) { lamps_ = (running ? 1u : 0u) | (fault ? 2u : 0u); }

  /// The machine's only timer: acts for the chip's timer, converter and USB controller at the end of a period.
  void period_ends();
  /// Carries out the command of a capital letter.
  void obey(char letter);

 private:
  static constexpr std::uint32_t kClock_Hz = 25'000'000;           // AN386: processor and watchdog
  static constexpr std::uint32_t kWatchdogTicks = kClock_Hz / 20;  // resets after twice 50 ms
  /// The emulated board and the computer have different times, and either may be slower. The board's time advances only
  /// as far as the computer's, so a faster computer may have to wait for it.
  static constexpr std::uint32_t kMostBehind_us = 20'000;

  static std::uint32_t ticks();
  void take_computer_time();

  std::array<ValueAxis, kAxes> axes_;
  std::array<RigidDrive, kAxes> drives_;
  Stop stop_;
  Supply supply_;
  Clock clock_;
  BenchLine line_{ticks, kClock_Hz / 11520};
  Serial serial_{line_};
  CableUsb usb_;
  MemoryFlash flash_;
  hal::mps2::Watchdog watchdog_;
  std::uint32_t period_us_ = 1000, feedings_ = 0, lamps_ = 0;
  volatile std::uint32_t passed_ticks_ = 0, beats_ = 0, overruns_ = 0;  // written in interrupts
  volatile std::uint32_t computer_time_us_ = 0;                         // written in the background
  volatile bool knows_computer_ = false, has_overrun_ = false, timer_runs_ = true;
  volatile bool background_runs_ = true;
};
static_assert(hal::Board<Board>);

/// The chip has no reset flags, so the survival record gives the cause.
inline ResetCause read_reset_cause() { return ResetCause::unknown; }

}  // namespace firmware::boards
