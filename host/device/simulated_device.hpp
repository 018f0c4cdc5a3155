// A simulated board that runs the firmware's application, and keeps its flash in a file.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "firmware/app/protocol/server.hpp"
#include "hal/pc/simulated_board.hpp"

namespace host {

struct SimulatedDeviceOptions {
  sim::DriveDescription x, y;  ///< what is plugged in
  std::string flash_file;      ///< empty: the board forgets
  std::uint64_t seed = 1;      ///< of the sensors' noise
};

/// One thread's: program, control periods and world take turns.
class SimulatedDevice {
 public:
  /// Powers up. Throws Failure(bad_input) for drives that the simulation cannot build or a file that is no flash.
  explicit SimulatedDevice(const SimulatedDeviceOptions& options);

  /// A control period, and the world's time for it. Returns that time, µs.
  std::uint32_t run_control_period();

  /// A round of the background, over any way to a host.
  template <hal::UsbHid Usb>
  void poll(Usb& usb) {
    server_->poll(usb);
    if (board_->parameter_flash().operations() != flash_operations_) keep_flash();
  }

  hal::pc::SimulatedBoard& board() { return *board_; }

  /// The program asked for a restart; power_up() does it. A cable is unplugged by it.
  bool wants_restart() const { return board_->wants_restart(); }
  void power_up();

 private:
  using Application = firmware::BoardApplication<float, hal::pc::SimulatedBoard>;

  void keep_flash();

  SimulatedDeviceOptions options_;
  firmware::ImageHeader image_;
  std::unique_ptr<hal::pc::SimulatedBoard> board_;
  std::unique_ptr<Application> application_;
  std::unique_ptr<firmware::ProtocolServer<Application>> server_;
  std::size_t flash_operations_ = 0;
  std::uint16_t resets_ = 0;
};

}  // namespace host
