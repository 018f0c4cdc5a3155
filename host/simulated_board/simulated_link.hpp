// A simulated board within this process. Its time passes while somebody waits for its reports, as fast as the computer
// can, and between calls as the computer's own does.
#pragma once

#include "host/link/report_link.hpp"
#include "host/simulated_board/simulated_device.hpp"

namespace host {

class SimulatedLink : public ReportLink {
 public:
  explicit SimulatedLink(const SimulatedDeviceOptions& options) : device_(options) { device_.usb().plug_in(); }

  void send(const hal::HidReport& report) override;
  /// `limit` is the board's time: as fast as this computer simulates it.
  std::optional<hal::HidReport> receive(std::chrono::milliseconds limit) override;
  std::string name() const override { return "model"; }

 private:
  std::int64_t run_control_period();
  void catch_up();

  SimulatedDevice device_;
  std::chrono::steady_clock::time_point left_ = std::chrono::steady_clock::now();  ///< when the last call returned
};

}  // namespace host
