#include "host/simulated_board/simulated_link.hpp"

#include "host/exit_codes.hpp"

namespace host {

void SimulatedLink::send(const hal::HidReport& report) {
  constexpr int kMostWaits = 1000;
  for (int waits = 0; !device_.usb().host_send(report); ++waits) {
    if (waits == kMostWaits) throw Failure(ExitCode::no_such_device, "the simulated board takes no more reports");
    run_control_period();
  }
}

std::optional<hal::HidReport> SimulatedLink::receive(std::chrono::milliseconds limit) {
  std::optional<hal::HidReport> received(std::in_place);
  device_.poll(device_.usb());
  const std::int64_t until_us = passed_us_ + std::chrono::microseconds(limit).count();
  bool came = device_.usb().host_receive(*received);
  while (!came && passed_us_ < until_us) {
    run_control_period();
    came = device_.usb().host_receive(*received);
  }
  return came ? received : std::nullopt;
}

void SimulatedLink::wait(std::chrono::milliseconds duration) {
  const std::int64_t until_us = passed_us_ + std::chrono::microseconds(duration).count();
  while (passed_us_ < until_us) run_control_period();
}

/// A board's background runs several rounds in a control period; each round sends one report.
void SimulatedLink::run_control_period() {
  passed_us_ += device_.run_control_period();
  for (int round = 0; round < 4; ++round) device_.poll(device_.usb());
  if (device_.wants_restart()) {
    device_.power_up();
    device_.usb().plug_in();
  }
}

}  // namespace host
