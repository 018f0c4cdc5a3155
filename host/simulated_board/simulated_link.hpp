// A simulated board within this process. Its clock runs only while a caller waits, as fast as the computer can
// simulate.
#pragma once

#include "host/link/report_link.hpp"
#include "host/simulated_board/simulated_device.hpp"

namespace host {

class SimulatedLink : public ReportLink {
 public:
  explicit SimulatedLink(const SimulatedDeviceOptions& options) : device_(options) { device_.usb().plug_in(); }

  void send(const hal::HidReport& report) override;
  /// `limit`: on the board's clock.
  std::optional<hal::HidReport> receive(std::chrono::milliseconds limit) override;
  std::chrono::steady_clock::time_point now() const override {
    return std::chrono::steady_clock::time_point(std::chrono::microseconds(passed_us_));
  }
  void wait(std::chrono::milliseconds duration) override;
  std::string name() const override { return "model"; }

 private:
  void run_control_period();

  SimulatedDevice device_;
  std::int64_t passed_us_ = 0;
};

}  // namespace host
