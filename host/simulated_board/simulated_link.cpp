#include "host/simulated_board/simulated_link.hpp"

#include <algorithm>

#include "host/exit_codes.hpp"

namespace host {

void SimulatedLink::send(const hal::HidReport& report) {
  catch_up();
  constexpr int kMostWaits = 1000;
  for (int waits = 0; !device_.usb().host_send(report); ++waits) {
    if (waits == kMostWaits) throw Failure(ExitCode::no_such_device, "the simulated board takes no more reports");
    run_control_period();
  }
  left_ = std::chrono::steady_clock::now();
}

std::optional<hal::HidReport> SimulatedLink::receive(std::chrono::milliseconds limit) {
  catch_up();
  std::optional<hal::HidReport> received(std::in_place);
  device_.poll(device_.usb());
  const auto most_us = std::chrono::microseconds(limit).count();
  std::int64_t passed_us = 0;
  bool came = device_.usb().host_receive(*received);
  while (!came && passed_us < most_us) {
    passed_us += run_control_period();
    came = device_.usb().host_receive(*received);
  }
  left_ = std::chrono::steady_clock::now();
  return came ? received : std::nullopt;
}

/// A board's background runs several rounds in a control period; each sends one report.
std::int64_t SimulatedLink::run_control_period() {
  const std::uint32_t period_us = device_.run_control_period();
  for (int round = 0; round < 4; ++round) device_.poll(device_.usb());
  if (device_.wants_restart()) {
    device_.power_up();
    device_.usb().plug_in();
  }
  return period_us;
}

void SimulatedLink::catch_up() {
  constexpr std::chrono::milliseconds kMost{50};  // more would look like a host that is silent
  const auto asleep = std::min<std::chrono::steady_clock::duration>(std::chrono::steady_clock::now() - left_, kMost);
  const auto most_us = std::chrono::duration_cast<std::chrono::microseconds>(asleep).count();
  for (std::int64_t passed_us = 0; passed_us < most_us;) passed_us += run_control_period();
}

}  // namespace host
