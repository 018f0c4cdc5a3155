// Checks of a board and its connection, each with a remedy.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/device/board_client.hpp"

namespace host {

enum class CheckResult { good, attention, bad };

struct DeviceCheck {
  CheckResult result = CheckResult::good;
  std::string what;
  std::string found;
  std::string remedy;  ///< empty when good
};

/// Checks whether Linux waits when it opens a board over hidraw.
DeviceCheck check_opening();

/// Reads the board's complete state, and tests the connection for a second. Changes nothing.
std::vector<DeviceCheck> check_device(BoardClient& board);

}  // namespace host
