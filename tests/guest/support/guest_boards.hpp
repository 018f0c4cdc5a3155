// Common code of the tests with boards on the guest's USB.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "host/link/usb_boards.hpp"

namespace guest_test {

inline bool in_guest() { return std::getenv("AXIS_GUEST") != nullptr; }

/// Waits until exactly `count` boards can be opened; false if this takes longer than `limit`.
inline bool boards_become(std::size_t count, const host::HidLibrary& library, std::chrono::seconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  do {
    const auto boards = host::find_usb_boards(library);
    const bool readable =
        std::none_of(boards.begin(), boards.end(), [](const host::UsbBoard& one) { return one.serial_number.empty(); });
    if (boards.size() == count && readable) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  } while (std::chrono::steady_clock::now() < end);
  return false;
}

}  // namespace guest_test
