// Copies faults from the axes into the log, and counts the board's running time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "firmware/app/store/fault_log.hpp"
#include "firmware/core/supervision/supervisor_state.hpp"

namespace firmware {

/// Background only. A fault is stored when its axis is off, so that later faults are known; it waits here while another
/// axis blocks flash writes.
template <typename Axes, hal::Flash Flash, typename ControlShutOut>
class FaultLogService {
 public:
  explicit FaultLogService(Flash& flash) : log_(flash) {}

  void start() {
    log_.load();
    written_s_ = run_s_ = log_.run_s();
  }

  /// Call it after start(): logs how the previous run ended.
  void note(LoggedFault ended) {
    ended.run_s = run_s_;
    if (waiting_ < kMostWaiting) queue_[waiting_++] = ended;
  }

  /// Call it often. `periods`: control periods so far, `rate` per second; `velocity_of(axis, scalar)`: rad/s (m/s).
  template <typename VelocityOf>
  void look(const Axes& axes, std::uint32_t periods, std::uint32_t rate, VelocityOf velocity_of) {
    for (; periods - counted_periods_ >= rate; counted_periods_ += rate) ++run_s_;
    for (std::size_t axis = 0; axis < Axes::kAxes; ++axis)
      if (!is_taken_[axis]) take(axes[axis], axis, velocity_of);
  }
  /// Call it before faults are cleared, after they have been copied: later faults are new ones.
  void forget() { is_taken_ = {}; }

  /// Writes entries; only while no axis is enabled.
  bool wants_flash() const { return waiting_ != 0 || run_s_ - written_s_ >= kTimeEvery_s; }
  bool write() {
    LoggedFault entry;
    if (waiting_ != 0) {
      entry = queue_[0];
      std::shift_left(queue_.begin(), queue_.end(), 1);
      --waiting_;
    } else {
      entry.run_s = run_s_;
    }
    written_s_ = run_s_;
    return log_.add(entry);
  }

  /// False beyond the oldest entry.
  bool read(std::size_t age, FaultLogPayload& payload) {
    const auto entry = log_.entry(age);
    payload = {run_s_, entry.value_or(LoggedFault{})};
    return entry.has_value();
  }

 private:
  static constexpr std::uint32_t kTimeEvery_s = 360;  ///< a tenth of an hour
  static constexpr std::size_t kMostWaiting = 4;

  template <typename Axis, typename VelocityOf>
  void take(const Axis& axis, std::size_t index, VelocityOf velocity_of) {
    if (waiting_ == kMostWaiting) return;
    LoggedFault entry;
    const auto velocity = [&] {
      const ControlShutOut guard;
      is_taken_[index] = axis.state() == SupervisorState::fault;
      const auto& last = axis.capture().last();
      entry.fault = static_cast<std::uint8_t>(axis.fault());
      entry.second_fault = static_cast<std::uint8_t>(axis.latched().second());
      entry.activity = static_cast<std::uint8_t>(axis.latched().activity());
      entry.homed = axis.latched().was_homed() ? 1 : 0;
      const std::int64_t counts = last.estimate.anchor_counts;
      entry.counts_low = static_cast<std::uint32_t>(counts);
      entry.counts_high = static_cast<std::int32_t>(counts >> 32);
      using Code = std::numeric_limits<std::int16_t>;
      entry.dac_code = static_cast<std::int16_t>(std::clamp<std::int32_t>(last.dac_code, Code::min(), Code::max()));
      return last.estimate.velocity;
    }();
    if (!is_taken_[index] || axis.fault() == AxisFault::other_axis_stopped) return;  // the other axis has the entry
    entry.axis = static_cast<std::uint8_t>(index);
    entry.run_s = run_s_;
    entry.velocity = velocity_of(index, velocity);
    queue_[waiting_++] = entry;
  }

  FaultLog<Flash> log_;
  std::array<LoggedFault, kMostWaiting> queue_{};
  std::size_t waiting_ = 0;
  std::array<bool, Axes::kAxes> is_taken_{};
  std::uint32_t run_s_ = 0, written_s_ = 0, counted_periods_ = 0;
};

}  // namespace firmware
