// What a test waits for. How long that takes is the computer's matter: a busy one must not fail a test.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

/// Asks `holds` every 20 ms, for at most a minute. Returns whether it came to hold.
inline bool wait_until(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}
