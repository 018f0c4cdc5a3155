// What could be wrong with a board and the way to it, each with its remedy.
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

/// How long Linux takes to open a board over hidraw.
DeviceCheck check_opening();

/// Asks the board about everything that it knows, and tries the way to it for a second. Changes nothing.
std::vector<DeviceCheck> check_device(BoardClient& board);

}  // namespace host
