// A simulated board that runs the firmware's application, and keeps its parameters and fault log in a file; images of
// its program last as long as it does.
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

/// A drive that is plugged in, with the switches of its axis.
struct SimulatedDrive {
  sim::DriveDescription drive;
  hal::pc::AxisWiring wiring{};
  std::shared_ptr<sim::ForeignMotion> motion{};  ///< moves in place of the drive's effects, where there is one
};

struct SimulatedDeviceOptions {
  std::vector<SimulatedDrive> drives;  ///< of axis x, y, …; as many as the board has axes, 1 to hal::kMostAxes
  std::string flash_file;              ///< empty: the board forgets
  std::uint64_t seed = 1;              ///< of the sensors' noise
  std::vector<hal::pc::SimulatedSurface> surfaces{};  ///< that a touch probe meets
};

/// The board's end of any way to a host; satisfies hal::UsbHid.
class UsbEnd {
 public:
  virtual ~UsbEnd() = default;
  virtual bool send(const hal::HidReport& report) = 0;
  virtual bool receive(hal::HidReport& report) = 0;
  virtual bool is_configured() = 0;
};

/// The program on a board with some number of axes, from power-up to reset.
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

/// One thread's: program, control periods and world take turns.
class SimulatedDevice {
 public:
  /// Powers up. Throws Failure(bad_input) for drives that the simulation cannot build, more or fewer of them than a
  /// board can have axes, or a file that is no flash.
  explicit SimulatedDevice(SimulatedDeviceOptions options);

  /// A control period, and the world's time for it. Returns that time, µs.
  std::uint32_t run_control_period() { return program_->run_control_period(); }

  /// A round of the background, over any way to a host.
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

  /// The program asked for a restart; power_up() does it. A cable is unplugged by it.
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
