// Processor in the loop on QEMU's netduinoplus2, which has the chip's core, FPU, interrupts, SysTick and USART1: the
// axes take readings from files or from the serial port, as `arg=` of -semihosting-config selects, and return their
// words.
#include <atomic>
#include <cstring>

#include "firmware/boards/image/board_scalar.hpp"
#include "firmware/boards/image/fault_handler.hpp"
#include "firmware/boards/pil/frame.hpp"
#include "firmware/boards/pil/pil_station.hpp"
#include "hal/qemu/semihosting.hpp"
#include "hal/serial_queue.hpp"
#include "hal/stm32f4/usart_port.hpp"

namespace firmware::boards {

namespace {

using hal::qemu::HostFile;
using Station = PilStation<BoardScalar>;

[[gnu::section(".ccm")]] constinit Station station;
hal::stm32f4::UsartPort usart(hal::stm32f4::usart1());
hal::SerialQueue<hal::stm32f4::UsartPort, 2048> serial(usart);

HostFile requests;
HostFile replies;
std::atomic<bool> run_ended = false;

template <typename T>
std::span<std::byte> bytes_of(T& object) {
  return std::as_writable_bytes(std::span(&object, 1));
}

void file_period() {
  PilRequest request;
  if (!requests.read(bytes_of(request)) || request.number == kPilEnd) {
    run_ended = true;
    return;
  }
  const PilReply reply = station.step(request);
  if (!replies.write(std::as_bytes(std::span(&reply, 1)))) run_ended = true;
}

/// Period in processor clocks. QEMU gives the chip its 168 MHz.
void start_control_interrupt(std::uint32_t clocks) {
  using hal::cortex_m::SysTick;
  hal::cortex_m::set_exception_priority(hal::cortex_m::kSysTickException, 2);
  SysTick& tick = hal::cortex_m::sys_tick();
  tick.RVR = clocks - 1;
  tick.CVR = 0;
  tick.CSR = SysTick::kEnable | SysTick::kInterrupt | SysTick::kProcessorClock;
}

constexpr std::uint32_t kClock_Hz = 168'000'000;
constexpr std::uint32_t kControlRate_Hz = 1000;

/// The control interrupt reads and writes the two FIFOs. While the emulated processor waits for them, its time stands
/// still.
void run_over_files() {
  constexpr const char* kRequests = "pil-requests";
  constexpr const char* kReplies = "pil-replies";
  if (!requests.open(kRequests, std::strlen(kRequests), HostFile::Mode::read_binary) ||
      !replies.open(kReplies, std::strlen(kReplies), HostFile::Mode::write_binary)) {
    hal::qemu::print("pil: cannot open pil-requests and pil-replies in the emulator's folder\n");
    hal::qemu::exit_emulator(1);
  }
  Station::Parameters parameters;
  if (!requests.read(bytes_of(parameters))) hal::qemu::exit_emulator(1);
  const PilConfigured configured = station.configure(parameters);
  if (!replies.write(std::as_bytes(std::span(&configured, 1)))) hal::qemu::exit_emulator(1);
  start_control_interrupt(kClock_Hz / kControlRate_Hz);
  while (!run_ended) continue;
  hal::qemu::exit_emulator(0);
}

/// The same over the serial port, with frames; a hello frame tells the other end that the receiver is on.
void run_over_serial() {
  FrameReceiver<sizeof(Station::Parameters)> receiver;
  const auto send = [](std::byte byte) {
    serial.send(byte);
    serial.poll();  // the emulated port takes any number at once
  };
  const auto next = [&receiver] {
    std::byte byte{};
    for (;;) {
      if (serial.receive(byte) && receiver.take(byte)) return receiver.payload();
      // Asking the emulated port without a pause keeps the emulator from filling it.
      for (volatile int pause = 0; pause < 200;) pause = pause + 1;
    }
  };
  send_frame({}, send);
  for (;;) {
    const std::span<const std::byte> payload = next();
    if (payload.size() == sizeof(Station::Parameters)) {
      Station::Parameters parameters;
      std::memcpy(static_cast<void*>(&parameters), payload.data(), sizeof parameters);
      const PilConfigured configured = station.configure(parameters);
      send_frame(std::as_bytes(std::span(&configured, 1)), send);
    } else if (payload.size() == sizeof(PilRequest)) {
      PilRequest request;
      std::memcpy(&request, payload.data(), sizeof request);
      if (request.number == kPilEnd) hal::qemu::exit_emulator(receiver.rejected() == 0 ? 0 : 2);
      const PilReply reply = station.step(request);
      send_frame(std::as_bytes(std::span(&reply, 1)), send);
    }
  }
}

}  // namespace

/// There is no converter and no enable line here.
void make_outputs_safe() noexcept {}

}  // namespace firmware::boards

extern "C" void control_interrupt() {
  using namespace firmware::boards;
  if (!run_ended) file_period();
}

extern "C" [[noreturn]] void run_board() {
  using namespace firmware::boards;
  arm_fault_detection();
  constexpr std::uint32_t kResetClock_Hz = 16'000'000;  // the RC oscillator; QEMU sends at once anyway
  usart.start(kResetClock_Hz, 115200);
  std::array<char, 64> wanted{};
  hal::qemu::command_line(wanted);
  if (std::strcmp(wanted.data(), "pil-files") == 0) run_over_files();
  if (std::strcmp(wanted.data(), "pil-serial") == 0) run_over_serial();
  hal::qemu::exit_emulator(1);
}
