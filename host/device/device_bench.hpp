// Speed and reliability of the connection to a board.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "host/device/board_client.hpp"

namespace host {

struct DeviceBench {
  double connect_ms = 0;  ///< open, identify, status
  double open_ms = 0;     ///< part of connect_ms, to find and open; over hidraw Linux 6.1 waits 50 ms (usbhid_open)
  std::size_t parameters = 0;
  double read_all_ms = 0;  ///< all parameters
  double set_all_ms = 0;   ///< all parameters staged, committed, read back and compared
  double exchange_median_ms = 0;
  double exchange_worst_ms = 0;
  double capture_s = 0;
  std::size_t capture_rows = 0;
  std::size_t capture_reports = 0;
  std::size_t lost_rows = 0;
};

/// Measures all times with the board's present parameters; changes nothing. Drives must be disabled.
/// `open` opens the connection; `progress` is called with the seconds of the capture so far.
DeviceBench bench_device(const std::function<std::unique_ptr<ReportLink>()>& open, double capture_s,
                         const std::function<void(double)>& progress = {});

}  // namespace host
