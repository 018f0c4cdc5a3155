// A link to a board: 64-byte reports in both directions, over USB or a socket.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "hal/usb_hid.hpp"

namespace host {

/// Keeps reports in order and loses none. An implementation reads in its own thread, because hidapi drops reports that
/// are not fetched in time.
class ReportLink {
 public:
  ReportLink() = default;
  ReportLink(const ReportLink&) = delete;
  ReportLink& operator=(const ReportLink&) = delete;
  virtual ~ReportLink() = default;

  /// Throws Failure (no_such_device) if the board is gone.
  virtual void send(const hal::HidReport& report) = 0;

  /// Waits at most `limit`; empty if no report arrived. Throws Failure (no_such_device) if the board is gone and all
  /// its reports have been fetched.
  virtual std::optional<hal::HidReport> receive(std::chrono::milliseconds limit) = 0;

  /// The clock for the board's time: the computer's, unless the board is simulated within this process.
  virtual std::chrono::steady_clock::time_point now() const { return std::chrono::steady_clock::now(); }
  virtual void wait(std::chrono::milliseconds duration) { std::this_thread::sleep_for(duration); }

  /// The name for --device: usb:SERIAL, socket:PATH.
  virtual std::string name() const = 0;

  /// The device file, by which other programs that have the board open are found; empty if unknown.
  virtual std::string file() const { return ""; }
};

}  // namespace host
