// The control interrupt. Compiled for speed; everything else in the image is compiled for size.
#include "firmware/boards/program/application.hpp"

namespace firmware::boards {

Board board;
Application application(board);
constinit Liveness liveness;
constinit hal::cortex_m::CycleMeter control_cycles;

namespace {

void remember(const Application::Axes& axes, LastState& last) {
  for (std::size_t i = 0; i < Application::kAxes; ++i) {
    const auto& telemetry = axes[i].telemetry();
    last.axis[i].encoder_counts = telemetry.encoder_counts;
    last.axis[i].dac_code = telemetry.dac_code;
    last.axis[i].enabled = telemetry.enabled ? 1 : 0;
    last.axis[i].fault = static_cast<std::uint32_t>(axes[i].fault());
  }
  last.control_periods = liveness.control_periods();
  last.supervisor_rounds = liveness.supervisor_rounds();
}

}  // namespace

}  // namespace firmware::boards

extern "C" void control_interrupt() {
  using namespace firmware::boards;
  control_cycles.begin();
  board.acknowledge_control();
  application.control_period();
  liveness.control_ran();
  board.control_has_run(liveness.supervisor_ran_lately() && !application.axes().must_cut_power());
  remember(application.axes(), survival_record().running);
  control_cycles.end();
}

extern "C" void adc_interrupt() { firmware::boards::board.recover_conversions(); }
