// cortex_bridge FILE SERIAL: USB controller for the emulated Cortex-M board, whose serial port is at the other end of
// FILE: connects it to vhci-hcd and transfers its reports.
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "firmware/boards/emulated/report_cable.hpp"
#include "hal/usbip/usbip_controller.hpp"
#include "hal/usbip/vhci_port.hpp"

namespace {

using namespace std::chrono_literals;

/// Bytes that are sent wait for flush().
class StreamPort {
 public:
  explicit StreamPort(const char* path) : file_(open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC)) {
    if (file_ < 0) throw std::runtime_error(std::string(path) + ": " + std::strerror(errno));
  }
  StreamPort(const StreamPort&) = delete;
  StreamPort& operator=(const StreamPort&) = delete;
  ~StreamPort() { close(file_); }

  void send(std::byte byte) { leaving_.push_back(byte); }
  void flush() {
    const ssize_t size = leaving_.empty() ? 0 : write(file_, leaving_.data(), leaving_.size());
    if (size > 0) leaving_.erase(leaving_.begin(), leaving_.begin() + size);
    if (size < 0 && errno != EAGAIN) throw std::runtime_error("the emulator has ended");
  }

  bool receive(std::byte& byte) {
    if (next_ == arrived_.size()) {
      arrived_.resize(4096);
      const ssize_t size = read(file_, arrived_.data(), arrived_.size());
      arrived_.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
      next_ = 0;
    }
    if (next_ == arrived_.size()) return false;
    byte = arrived_[next_++];
    return true;
  }

 private:
  int file_;
  std::vector<std::byte> leaving_, arrived_;
  std::size_t next_ = 0;
};

using Cable = firmware::boards::ComputerEnd<StreamPort>;

/// Transfers reports in one direction; keeps a report for which there is no room yet.
class Lane {
 public:
  template <typename From, typename To>
  void carry(From& from, To& to) {
    for (;;) {
      hal::HidReport report{};
      if (!kept_ && from.receive(report)) kept_ = report;
      if (!kept_ || !to.send(*kept_)) return;
      kept_.reset();
    }
  }
  void clear() { kept_.reset(); }

 private:
  std::optional<hal::HidReport> kept_;
};

void run(const char* path, const char* serial_number) {
  StreamPort stream(path);
  const auto cable_of_its_own = std::make_unique<Cable>(stream);  // too large for a stack
  Cable& cable = *cable_of_its_own;
  hal::tinyusb::HidPort usb;
  if (!usb.start(serial_number)) throw std::runtime_error("no USB stack");
  std::unique_ptr<hal::usbip::UsbipController> controller;
  Lane to_board, to_host;
  auto told = std::chrono::steady_clock::now();
  for (;;) {
    const auto passed = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - told);
    if (passed >= 1ms) {
      cable.pass_time(static_cast<std::uint32_t>(passed.count()));
      told += passed;
    }
    while (cable.poll()) continue;
    if (cable.heard_hello()) {  // the board has started: its controller reconnects, as on a real board
      controller.reset();
      to_board.clear();
      to_host.clear();
      controller = std::make_unique<hal::usbip::UsbipController>(hal::usbip::plug_into_vhci(), usb);
    }
    if (!controller) {
      stream.flush();
      std::this_thread::sleep_for(1ms);
      continue;
    }
    if (!controller->serve(1ms)) return;
    if (usb.is_configured() != cable.is_configured()) cable.set_configured(usb.is_configured());
    to_board.carry(usb, cable);
    to_host.carry(cable, usb);
    stream.flush();
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  try {
    run(arguments[1], arguments[2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cortex_bridge: %s\n", error.what());
    return 1;
  }
}
