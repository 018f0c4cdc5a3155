// Keeps the last 100 ms of an axis; a fault freezes them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/core/axis_telemetry.hpp"

namespace firmware {

inline constexpr std::size_t kCaptureRows = 101;  // 100 ms at 1 kHz, both ends included

template <typename Scalar>
class CaptureRing {
 public:
  /// Takes every n-th sample.
  constexpr void configure(std::int32_t stride) {
    stride_ = stride;
    restart();
  }

  constexpr void restart() {
    next_ = 0;
    is_full_ = false;
    until_next_ = 1;
    is_frozen_ = false;
  }

  constexpr void take(const AxisSample<Scalar>& seen) {
    if (--until_next_ > 0) return;
    until_next_ = stride_;
    add(seen);
  }

  /// Freezes the rows, with the sample of the fault as the last.
  constexpr void freeze(const AxisSample<Scalar>& at_fault) {
    if (is_frozen_) return;
    add(at_fault);
    is_frozen_ = true;
  }

  constexpr bool is_frozen() const { return is_frozen_; }
  constexpr std::size_t size() const { return is_full_ ? kCaptureRows : next_; }
  /// Oldest first, index < size().
  constexpr const AxisSample<Scalar>& row(std::size_t index) const {
    return rows_[is_full_ ? (next_ + index) % kCaptureRows : index];
  }
  /// The newest row; all zero if there is no row yet.
  constexpr const AxisSample<Scalar>& last() const { return rows_[(next_ + kCaptureRows - 1) % kCaptureRows]; }
  /// Samples from one row to the next.
  constexpr std::int32_t stride() const { return stride_; }

 private:
  constexpr void add(const AxisSample<Scalar>& seen) {
    rows_[next_] = seen;
    if (++next_ == kCaptureRows) {
      next_ = 0;
      is_full_ = true;
    }
  }

  std::array<AxisSample<Scalar>, kCaptureRows> rows_{};
  std::size_t next_ = 0;
  std::int32_t stride_ = 1;
  std::int32_t until_next_ = 1;
  bool is_full_ = false;
  bool is_frozen_ = false;
};

}  // namespace firmware
