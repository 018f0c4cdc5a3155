// A simulated board that runs the firmware's application. It stores its parameters and fault log in a file; images of
// its program are lost at the end.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/pc/simulated_axis.hpp"
#include "hal/pc/simulated_flash.hpp"
#include "hal/pc/simulated_panel.hpp"
#include "hal/pc/simulated_usb.hpp"
#include "sim/drive_description.hpp"

namespace host {

/// A connected drive, with the switches of its axis.
struct SimulatedDrive {
  sim::DriveDescription drive;
  hal::pc::AxisWiring wiring{};
  std::shared_ptr<sim::ForeignMotion> motion{};  ///< replaces the drive's effects, if set
};

struct SimulatedDeviceOptions {
  std::vector<SimulatedDrive> drives;  ///< drives of axes x, y, …; 1 to hal::kMostAxes, one for each axis of the board
  std::string flash_file;              ///< file for parameters and fault log; empty: not kept
  std::uint64_t seed = 1;              ///< seed of the sensors' noise
  std::vector<hal::pc::SimulatedSurface> surfaces{};  ///< surfaces for a touch probe
};

/// The board's end of any link to a host; satisfies hal::UsbHid.
class UsbEnd {
 public:
  virtual ~UsbEnd() = default;
  virtual bool send(const hal::HidReport& report) = 0;
  virtual bool receive(hal::HidReport& report) = 0;
  virtual bool is_configured() = 0;
};

/// The program on a board with a certain number of axes, from power-up to reset.
class SimulatedProgram {
 public:
  virtual ~SimulatedProgram() = default;
  virtual std::uint32_t run_control_period() = 0;
  virtual void poll(UsbEnd& usb) = 0;
  virtual bool wants_restart() const = 0;
  virtual hal::pc::SimulatedUsb& usb() = 0;
  virtual hal::pc::SimulatedFlash& flash() = 0;
  virtual const hal::pc::SimulatedFlash& images() = 0;
};

/// For use in one thread: program, control periods and environment run alternately.
class SimulatedDevice {
 public:
  /// Powers up. Throws Failure(bad_input) for drives that the simulation cannot build, for an impossible number of
  /// drives, or for a file that does not contain a flash.
  explicit SimulatedDevice(SimulatedDeviceOptions options);

  /// Runs a control period of the program and the environment. Returns its duration, µs.
  std::uint32_t run_control_period() { return program_->run_control_period(); }

  /// Runs a round of the background, with any link to a host.
  template <hal::UsbHid Usb>
  void poll(Usb& usb) {
    struct End : UsbEnd {
      explicit End(Usb& usb) : usb_(usb) {}
      bool send(const hal::HidReport& report) override { return usb_.send(report); }
      bool receive(hal::HidReport& report) override { return usb_.receive(report); }
      bool is_configured() override { return usb_.is_configured(); }
      Usb& usb_;
    } end(usb);
    program_->poll(end);
    if (program_->flash().operations() != flash_operations_) keep_flash();
  }

  hal::pc::SimulatedUsb& usb() { return program_->usb(); }

  /// Whether the program has requested a restart, which power_up() performs and which disconnects the cable.
  bool wants_restart() const { return program_->wants_restart(); }
  void power_up();

 private:
  void keep_flash();

  SimulatedDeviceOptions options_;
  std::unique_ptr<SimulatedProgram> program_;
  std::size_t flash_operations_ = 0;
  std::uint16_t resets_ = 0;
};

}  // namespace host
