// USB HID as two bounded queues: the board's end and the host's end of one cable.
#pragma once

#include <cstddef>
#include <deque>

#include "hal/usb_hid.hpp"

namespace hal::pc {

/// send, receive and is_configured are the board's end. Reports wait and are never dropped.
class SimulatedUsb {
 public:
  /// Number of reports that wait in each direction before a sender is refused.
  explicit SimulatedUsb(std::size_t depth) : depth_(depth) {}

  bool send(const HidReport& report) { return configured_ && put(to_host_, report); }
  bool receive(HidReport& report) { return take(to_board_, report); }
  bool is_configured() const { return configured_; }

  bool host_send(const HidReport& report) { return configured_ && put(to_board_, report); }
  bool host_receive(HidReport& report) { return take(to_host_, report); }
  void plug_in() { configured_ = true; }
  /// Reports on their way are lost, as on a real cable.
  void unplug() {
    configured_ = false;
    to_host_.clear();
    to_board_.clear();
  }

 private:
  bool put(std::deque<HidReport>& queue, const HidReport& report) const {
    if (queue.size() >= depth_) return false;
    queue.push_back(report);
    return true;
  }
  static bool take(std::deque<HidReport>& queue, HidReport& report) {
    if (queue.empty()) return false;
    report = queue.front();
    queue.pop_front();
    return true;
  }

  std::size_t depth_;
  bool configured_ = false;
  std::deque<HidReport> to_host_;
  std::deque<HidReport> to_board_;
};

static_assert(UsbHid<SimulatedUsb>);

}  // namespace hal::pc
