#include "host/axistool/motion_consent.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

#include "host/exit_codes.hpp"

namespace axistool {

namespace {
std::atomic<bool> was_interrupted = false;
}

std::string box_text(const host::ExcitationLimits& box, sim::DriveKind kind) {
  const char* unit = kind == sim::DriveKind::rotary ? "mm" : "m";
  return fmt::format("{:g} {} of travel ({:g} to either side of where it stands), {:g} {}/s, {:g} V, {:g} s",
                     box.travel, unit, box.travel / 2.0, box.speed, unit, box.volts, box.time_s);
}

void catch_interrupts() {
  std::signal(SIGINT, [](int) { was_interrupted = true; });
  std::signal(SIGTERM, [](int) { was_interrupted = true; });
}

bool interrupted() { return was_interrupted; }

void count_down(int seconds) {
  for (; seconds > 0 && !was_interrupted; --seconds) {
    fmt::print(stderr, "{} … ", seconds);
    std::fflush(stderr);
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  fmt::print(stderr, "\n");
  if (was_interrupted) throw host::Failure(host::ExitCode::refused, "interrupted before anything moved");
}

}  // namespace axistool
