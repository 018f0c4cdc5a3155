// Image that captures four channels at 20 kHz in the control interrupt, and tells whether a sample is missing.
#include <array>
#include <cstdint>

#include "firmware/app/triggered_capture.hpp"
#include "firmware/boards/image/fault_handler.hpp"
#include "firmware/boards/pil/value_axis.hpp"
#include "firmware/core/supervision/axis_group.hpp"
#include "hal/axis_count.hpp"
#include "hal/cortex_m/registers.hpp"
#include "tests/firmware/paper_axes.hpp"
#include "tests/target/images/instruction_counter.hpp"

namespace firmware::boards {
void make_outputs_safe() noexcept {}
}  // namespace firmware::boards

namespace {

using firmware::Channel;
using firmware::boards::ValueAxis;

constexpr std::uint32_t kClock_Hz = 168'000'000, kRate_Hz = 20'000;
constexpr std::uint32_t kRows = kRate_Hz / 10;  // 100 ms
constexpr std::uint32_t kLevel = 3210;

std::array<ValueAxis, hal::kAxisCount> io;
firmware::AxisGroup<float, ValueAxis, hal::kAxisCount> axes(io);
firmware::TriggeredMemory memory;
firmware::TriggeredCapture capture;
volatile std::uint32_t periods = 0;

constexpr std::uint16_t bit(Channel channel) {
  return static_cast<std::uint16_t>(1u << static_cast<unsigned>(channel));
}

/// The encoder counts periods, so that a row shows when it was taken.
std::uint32_t rows_out_of_step(const firmware::TriggerStatePayload& state) {
  std::uint32_t wrong = 0;
  firmware::TriggeredPayload part;
  for (std::uint32_t row = 0; row < state.rows; ++row) {
    const std::uint32_t at = row * state.half_words + 1;  // behind the converter's word
    capture.read(at, part);
    const auto expected = static_cast<std::uint16_t>(kLevel + 1 + row - state.trigger_row);
    if (part.half_word[0] != expected) ++wrong;
  }
  return wrong;
}

}  // namespace

extern "C" void control_interrupt() {
  periods = periods + 1;
  for (ValueAxis& axis : io) {
    axis.encoder().reading = {periods, true};
    axis.tachometer().reading = {0, true};
  }
  axes.step({periods * (1'000'000 / kRate_Hz), false, false, false});
  if (capture.is_running()) capture.take(axes);
}

extern "C" [[noreturn]] void run_board() {
  firmware::boards::arm_fault_detection();
  firmware::TriggerRequest request{};
  request.every = 1;
  request.channels[0] =
      bit(Channel::dac_code) | bit(Channel::counts) | bit(Channel::tachometer_velocity) | bit(Channel::reference);
  request.kind = static_cast<std::uint8_t>(firmware::TriggerKind::edge);
  request.channel = static_cast<std::uint8_t>(Channel::counts);
  request.level = kLevel;
  request.before = kRows / 4;
  request.after = kRows - kRows / 4;
  for (std::size_t i = 0; i < axes.kAxes; ++i)
    axes[i].configure(firmware_test::parameters_of<float>(firmware_test::kPaperX));
  capture.adopt(memory);
  capture.arm(request);
  using hal::cortex_m::SysTick;
  hal::cortex_m::sys_tick().RVR = kClock_Hz / kRate_Hz - 1;
  hal::cortex_m::sys_tick().CSR = SysTick::kEnable | SysTick::kInterrupt | SysTick::kProcessorClock;
  while (periods < 2 * kRows + kLevel) continue;
  hal::cortex_m::sys_tick().CSR = 0;
  asm volatile("" ::: "memory");  // the interrupt has written the memory
  const firmware::TriggerStatePayload state = capture.state();
  target_image::EmulatorPort port;
  firmware::boards::TextWriter(port) << "capture rows " << state.rows << " trigger_row " << state.trigger_row
                                     << " out_of_step " << rows_out_of_step(state) << "\n";
  hal::qemu::exit_emulator(0);
}
