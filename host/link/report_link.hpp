// A way to a board: 64-byte reports both ways, over USB or a socket.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "hal/usb_hid.hpp"

namespace host {

/// The link keeps reports in order and loses none on the way to the program: an implementation reads in a thread of its
/// own, because hidapi drops what is not fetched in time.
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

  /// The clock that the board's time goes by: the computer's, unless the board is simulated within this process.
  virtual std::chrono::steady_clock::time_point now() const { return std::chrono::steady_clock::now(); }
  virtual void wait(std::chrono::milliseconds duration) { std::this_thread::sleep_for(duration); }

  /// As --device names it: usb:SERIAL, socket:PATH.
  virtual std::string name() const = 0;

  /// What other programs that use the board have open too; empty where that cannot be told.
  virtual std::string file() const { return ""; }
};

}  // namespace host
