#include "host/device/socket_board.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <ctime>

namespace host {

namespace {

using std::chrono::microseconds;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;

class SocketBoard {
 public:
  SocketBoard(SimulatedDevice& device, const OwnedDescriptor& listener) : device_(device), listener_(listener) {}

  void run(const std::atomic<bool>& stop) {
    constexpr auto kMostLag = std::chrono::milliseconds(20);  // more would look like a host that is silent
    auto next = steady_clock::now();
    while (!stop) {
      next += microseconds(device_.run_control_period());
      device_.poll(usb());
      deliver();
      if (device_.wants_restart()) restart();
      if (steady_clock::now() - next > kMostLag) next = steady_clock::now();
      do serve_until(next);
      while (steady_clock::now() < next && !stop);
    }
  }

 private:
  hal::pc::SimulatedUsb& usb() { return device_.board().usb(); }

  /// Waits for the host, at most until the next control period is due, and answers it at once.
  void serve_until(steady_clock::time_point due) {
    const auto left = std::max(nanoseconds(due - steady_clock::now()), nanoseconds(0));
    const timespec patience{std::chrono::duration_cast<std::chrono::seconds>(left).count(),
                            (left % std::chrono::seconds(1)).count()};
    pollfd end{host_ ? host_.get() : listener_.get(), POLLIN, 0};
    if (::ppoll(&end, 1, &patience, nullptr) <= 0) return;
    if (!host_) {
      host_ = OwnedDescriptor(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
      if (!host_) return;
      constexpr int kRoom = 1 << 20;  // for a host that the computer keeps waiting
      ::setsockopt(host_.get(), SOL_SOCKET, SO_SNDBUF, &kRoom, sizeof kRoom);
      usb().plug_in();
      return;
    }
    hal::HidReport report;
    if (::recv(host_.get(), report.data(), report.size(), 0) != static_cast<ssize_t>(report.size())) {
      unplug();
      return;
    }
    usb().host_send(report);
    device_.poll(usb());
    deliver();
  }

  /// What the board has sent goes on its way, as long as the host takes it.
  void deliver() {
    while (host_) {
      if (!waits_ && !usb().host_receive(report_)) return;
      waits_ = ::send(host_.get(), report_.data(), report_.size(), MSG_NOSIGNAL) < 0;
      if (!waits_) continue;
      if (errno != EAGAIN) unplug();
      return;
    }
  }

  void unplug() {
    host_ = OwnedDescriptor();
    waits_ = false;
    usb().unplug();
  }

  void restart() {
    unplug();
    device_.power_up();
  }

  SimulatedDevice& device_;
  const OwnedDescriptor& listener_;
  OwnedDescriptor host_;
  hal::HidReport report_{};
  bool waits_ = false;  ///< report_ is still to be sent
};

}  // namespace

void serve_simulated_device(SimulatedDevice& device, const OwnedDescriptor& listener, const std::atomic<bool>& stop) {
  SocketBoard(device, listener).run(stop);
}

}  // namespace host
