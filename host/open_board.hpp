// Opens a board by its name: usb:SERIAL, sim, socket:PATH.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "host/device/board_client.hpp"

namespace host {

/// As open_device() has it, and within this process: "model:FILE", a simulated board with this drive on every axis;
/// "plant:DRIVE.toml:COMMAND", a board of one axis around a program. `patience`: how long an answer may take. Throws
/// Failure.
BoardClient open_board(const std::string& device, std::chrono::duration<double> patience);

/// "x" -> 0, on a board with `axes` axes. Throws Failure(usage).
std::uint8_t axis_index(const std::string& name, std::size_t axes);

}  // namespace host
