#include "firmware/boards/axis-f405/control.hpp"

#include <array>
#include <atomic>

namespace firmware::boards {

namespace {

using Axes = AxisGroup<BoardScalar, BoardAxisHal>;

Board the_board;
// The control law's data lie in the core-coupled memory, which no DMA ever makes wait.
[[gnu::section(".ccm")]] Axes axes(the_board.axis(0), the_board.axis(1));

std::atomic<bool> store_is_damaged = false;

class ControlShutOut {
 public:
  ControlShutOut() {
    asm volatile("mrs %0, primask" : "=r"(before_));
    asm volatile("cpsid i" ::: "memory");
  }
  ~ControlShutOut() { asm volatile("msr primask, %0" ::"r"(before_) : "memory"); }
  ControlShutOut(const ControlShutOut&) = delete;
  ControlShutOut& operator=(const ControlShutOut&) = delete;

 private:
  std::uint32_t before_ = 0;
};

void remember(std::size_t index) {
  LastAxisState& last = survival_record().running.axis[index];
  const auto& telemetry = axes[index].telemetry();
  last.encoder_counts = telemetry.encoder_counts;
  last.dac_code = telemetry.dac_code;
  last.enabled = telemetry.enabled ? 1 : 0;
  last.fault = static_cast<std::uint32_t>(axes[index].fault());
}

}  // namespace

Board& board() { return the_board; }

ParameterError configure_axis(std::size_t axis, const AxisParameters<BoardScalar>& parameters) {
  const ControlShutOut guard;
  axes.board().configure(BoardWatch::default_limits(kControlPeriod_s));
  return axes[axis].configure(parameters);
}

bool enable_axis(std::size_t axis) {
  const ControlShutOut guard;
  return axes[axis].enable();
}

bool disable_axis(std::size_t axis) {
  const ControlShutOut guard;
  return axes[axis].disable();
}

bool jog_axis(std::size_t axis, BoardScalar velocity) {
  const ControlShutOut guard;
  return axes[axis].jog(velocity);
}

void stop_axis(std::size_t axis) {
  const ControlShutOut guard;
  axes[axis].stop();
}

bool clear_axis_fault(std::size_t axis) {
  const ControlShutOut guard;
  return axes[axis].clear_fault();
}

SupervisorState axis_state(std::size_t axis) { return axes[axis].state(); }
AxisFault axis_fault(std::size_t axis) { return axes[axis].fault(); }

void host_commands_motion(bool commands) {
  const ControlShutOut guard;
  axes.board().host_commands(commands);
}

void host_heard() {
  const ControlShutOut guard;
  axes.board().host_heard();
}

AxisTelemetry<BoardScalar> axis_telemetry(std::size_t axis) {
  const ControlShutOut guard;
  return axes[axis].telemetry();
}

bool move_axis(std::size_t axis, std::int64_t target_counts) {
  {
    const ControlShutOut guard;
    if (!axes[axis].is_at_rest()) return false;
  }
  // At rest the reference stands still, and only this background can change that.
  const MovePlanResult planned = axes[axis].plan_move_to(CountPosition::at(target_counts));
  const ControlShutOut guard;
  return planned.error == MovePlanError::none && axes[axis].start(planned.plan);
}

void report_damaged_store() { store_is_damaged = true; }

void control_period() {
  axes.step({the_board.clock().now_us(), the_board.emergency_stop().is_pressed(), the_board.supply().is_low(),
             store_is_damaged});
  for (std::size_t i = 0; i < kAxes; ++i) remember(i);
}

}  // namespace firmware::boards
