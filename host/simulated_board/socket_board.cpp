#include "host/simulated_board/socket_board.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <optional>
#include <vector>

namespace host {

namespace {

using std::chrono::microseconds;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;

/// A connected program. As with hidraw, every program receives all reports of the board.
struct Host {
  OwnedDescriptor socket;
  std::optional<hal::HidReport> waiting;  ///< a report for which the socket had no room yet
};

class SocketBoard {
 public:
  SocketBoard(SimulatedDevice& device, const OwnedDescriptor& listener) : device_(device), listener_(listener) {}

  void run(const std::atomic<bool>& stop) {
    constexpr auto kMostLag = std::chrono::milliseconds(20);  // a longer lag would look like a silent host
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
  hal::pc::SimulatedUsb& usb() { return device_.usb(); }

  /// Waits for the hosts, at most until the next control period is due, and answers them at once.
  void serve_until(steady_clock::time_point due) {
    const auto left = std::max(nanoseconds(due - steady_clock::now()), nanoseconds(0));
    const timespec patience{std::chrono::duration_cast<std::chrono::seconds>(left).count(),
                            (left % std::chrono::seconds(1)).count()};
    std::vector<pollfd> ends{{listener_.get(), POLLIN, 0}};
    for (const Host& host : hosts_) ends.push_back({host.socket.get(), POLLIN, 0});
    if (::ppoll(ends.data(), ends.size(), &patience, nullptr) <= 0) return;
    for (std::size_t i = ends.size() - 1; i > 0; --i)
      if (ends[i].revents != 0) serve(i - 1);
    if (ends[0].revents != 0) welcome();
  }

  void welcome() {
    OwnedDescriptor socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!socket) return;
    constexpr int kRoom = 1 << 20;  // for a host that does not get processor time
    ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDBUF, &kRoom, sizeof kRoom);
    hosts_.push_back({std::move(socket), {}});
    usb().plug_in();
  }

  void serve(std::size_t index) {
    if (index >= hosts_.size()) return;  // another host was lost meanwhile
    hal::HidReport report;
    const ssize_t got = ::recv(hosts_[index].socket.get(), report.data(), report.size(), 0);
    if (got < 0 && errno == EAGAIN) return;
    if (got != static_cast<ssize_t>(report.size())) {
      lose(index);
      return;
    }
    usb().host_send(report);
    device_.poll(usb());
    deliver();
  }

  /// Passes on the board's reports while at least one host accepts them. A host that alone delays the others misses
  /// reports.
  void deliver() {
    for (std::size_t i = hosts_.size(); i-- > 0;)
      if (hosts_[i].waiting && !is_sent(i, *hosts_[i].waiting) && hosts_.size() == 1) return;
    hal::HidReport report;
    while (!hosts_.empty() && usb().host_receive(report)) {
      bool anybody = false;
      for (std::size_t i = hosts_.size(); i-- > 0;) anybody = (!hosts_[i].waiting && is_sent(i, report)) || anybody;
      if (!anybody) return;
    }
  }

  /// False if the report has to wait, or if the host is gone.
  bool is_sent(std::size_t index, const hal::HidReport& report) {
    Host& host = hosts_[index];
    if (::send(host.socket.get(), report.data(), report.size(), MSG_NOSIGNAL) >= 0) {
      host.waiting.reset();
      return true;
    }
    if (errno == EAGAIN)
      host.waiting = report;
    else
      lose(index);
    return false;
  }

  /// Removes a host; without hosts the cable is disconnected.
  void lose(std::size_t index) {
    hosts_.erase(hosts_.begin() + static_cast<std::ptrdiff_t>(index));
    if (hosts_.empty()) usb().unplug();
  }

  void restart() {
    hosts_.clear();
    usb().unplug();
    device_.power_up();
  }

  SimulatedDevice& device_;
  const OwnedDescriptor& listener_;
  std::vector<Host> hosts_;
};

}  // namespace

void serve_simulated_device(SimulatedDevice& device, const OwnedDescriptor& listener, const std::atomic<bool>& stop) {
  SocketBoard(device, listener).run(stop);
}

}  // namespace host
