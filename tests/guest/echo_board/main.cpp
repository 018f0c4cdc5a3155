// echo_board SERIAL: a board without a protocol, plugged into vhci-hcd: returns each report with its bits inverted, and
// sends a numbered report each millisecond while it is asked to.
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>

#include "hal/usbip/usbip_controller.hpp"
#include "hal/usbip/vhci_port.hpp"
#include "tests/guest/echo_board/echo_report.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

class EchoBoard {
 public:
  explicit EchoBoard(hal::tinyusb::HidPort& port) : port_(port) {}

  void run_once() {
    if (kept_ && port_.send(*kept_)) kept_.reset();
    hal::HidReport report{};
    while (!kept_ && port_.receive(report)) {
      if (echo_board::is_stream_request(report)) {
        remaining_ = echo_board::number_of(report);
        next_ = Clock::now();
        continue;
      }
      const hal::HidReport answer = echo_board::inverted(report);
      if (!port_.send(answer)) kept_ = answer;
    }
    for (; remaining_ > 0 && Clock::now() >= next_; next_ += 1ms) {
      if (!port_.send(echo_board::numbered(sent_))) break;
      ++sent_;
      --remaining_;
    }
  }

 private:
  hal::tinyusb::HidPort& port_;
  std::optional<hal::HidReport> kept_;  ///< an answer for which there was no room yet
  std::uint32_t remaining_ = 0, sent_ = 0;
  Clock::time_point next_;
};

}  // namespace

int main(int count, char** arguments) {
  try {
    hal::tinyusb::HidPort port;
    if (count != 2 || !port.start(arguments[1])) return 2;
    hal::usbip::UsbipController controller(hal::usbip::plug_into_vhci(), port);
    EchoBoard board(port);
    while (controller.serve(1ms)) board.run_once();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "echo_board: %s\n", error.what());
    return 1;
  }
}
