// Opens a board by its device name: usb:SERIAL, sim, socket:PATH.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "host/device/board_client.hpp"

namespace host {

/// Names as in open_device(), and boards within this process: "model:FILE", a simulated board with this drive on every
/// axis; "plant:DRIVE.toml:COMMAND", a simulated board with one axis whose plant is a program. `patience`: time-out for
/// an answer. Throws Failure.
BoardClient open_board(const std::string& device, std::chrono::duration<double> patience);

/// "x" -> 0, on a board with `axes` axes. Throws Failure(usage).
std::uint8_t axis_index(const std::string& name, std::size_t axes);

}  // namespace host
