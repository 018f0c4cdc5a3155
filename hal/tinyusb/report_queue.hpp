// A bounded first-in-first-out queue of reports.
#pragma once

#include "hal/usb_hid.hpp"

namespace hal::tinyusb {

template <std::size_t capacity>
class ReportQueue {
 public:
  bool is_full() const { return count_ == capacity; }

  /// False when it is full; the report is then not taken.
  bool put(const HidReport& report) {
    if (is_full()) return false;
    reports_[(first_ + count_) % capacity] = report;
    ++count_;
    return true;
  }

  /// False when it is empty.
  bool take(HidReport& report) {
    if (count_ == 0) return false;
    report = reports_[first_];
    first_ = (first_ + 1) % capacity;
    --count_;
    return true;
  }

  void clear() { count_ = 0; }

 private:
  std::array<HidReport, capacity> reports_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace hal::tinyusb
