// A link to a board: 64-byte reports in both directions, over USB or a socket.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "hal/usb_hid.hpp"

namespace host {

/// Keeps reports in order and loses none on the way to the program: an implementation reads in its own thread, because
/// hidapi drops reports that are not fetched in time.
class ReportLink {
 public:
  ReportLink() = default;
  ReportLink(const ReportLink&) = delete;
  ReportLink& operator=(const ReportLink&) = delete;
  virtual ~ReportLink() = default;

  /// Throws Failure (no_such_device) when the board is gone.
  virtual void send(const hal::HidReport& report) = 0;

  /// Waits at most `limit`; empty when nothing came. Throws Failure (no_such_device) when the board is gone and all
  /// that it had sent has been fetched.
  virtual std::optional<hal::HidReport> receive(std::chrono::milliseconds limit) = 0;

  /// Clock of the board's time: the computer's, unless the board is simulated within this process.
  virtual std::chrono::steady_clock::time_point now() const { return std::chrono::steady_clock::now(); }
  virtual void wait(std::chrono::milliseconds duration) { std::this_thread::sleep_for(duration); }

  /// As --device names it: usb:SERIAL, socket:PATH.
  virtual std::string name() const = 0;

  /// Other programs that have the board open; empty if that is unknown.
  virtual std::string file() const { return ""; }
};

}  // namespace host
