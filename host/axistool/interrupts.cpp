#include "host/axistool/interrupts.hpp"

#include <atomic>
#include <csignal>

namespace axistool {

namespace {

std::atomic<bool> was_interrupted = false;

void handle_with(void (*handler)(int)) {
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
  if (std::signal(SIGHUP, handler) == SIG_IGN)
    std::signal(SIGHUP, SIG_IGN);  // started by nohup: closing the terminal must not end it
}

}  // namespace

void catch_interrupts() {
  handle_with([](int) { was_interrupted = true; });
}

void release_interrupts() { handle_with(SIG_DFL); }

bool interrupted() { return was_interrupted; }

}  // namespace axistool
