// The control interrupt. Compiled for speed; everything else in the image is compiled for size.
#include "firmware/boards/axis-f405/application.hpp"

namespace firmware::boards {

Board board;
Application application(board);
constinit Liveness liveness;

namespace {

void remember(const Application::Axes& axes, LastState& last) {
  for (std::size_t i = 0; i < kAxisCount; ++i) {
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
  board.acknowledge_control();
  application.control_period();
  liveness.control_ran();
  remember(application.axes(), survival_record().running);
}
