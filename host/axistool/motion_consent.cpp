#include "host/axistool/motion_consent.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "host/axistool/interrupts.hpp"
#include "host/exit_codes.hpp"

namespace axistool {

std::string box_text(const host::ExcitationLimits& box, sim::DriveKind kind) {
  const char* unit = kind == sim::DriveKind::rotary ? "mm" : "m";
  return fmt::format("{:g} {} of travel ({:g} to either side of its position), {:g} {}/s, {:g} V, {:g} s", box.travel,
                     unit, box.travel / 2.0, box.speed, unit, box.volts, box.time_s);
}

void count_down(int seconds) {
  for (; seconds > 0 && !interrupted(); --seconds) {
    fmt::print(stderr, "{} … ", seconds);
    std::fflush(stderr);
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  fmt::print(stderr, "\n");
  if (interrupted()) throw host::Failure(host::ExitCode::refused, "interrupted before anything moved");
}

}  // namespace axistool
