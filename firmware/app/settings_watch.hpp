// Checks in the background that parameters and pin modes still have the values that were set.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "firmware/app/crc32.hpp"
#include "firmware/app/parameters/parameter_values.hpp"

namespace firmware {

/// Watches the parameter values, what each axis computes from them (gains, curves, thresholds), the board's limits, and
/// the modes of the chip's pins. A disturbance or a defect may change them.
///
/// Every poll() adds kBytes to a checksum. The first pass over all settings after begin_anew() is the one with which
/// the later passes are compared. So a change is found within two passes, which take some 300 polls.
template <typename Axes, typename Board>
class SettingsWatch {
 public:
  SettingsWatch(const ParameterValues& values, const Axes& axes, const Board& board)
      : values_(values), axes_(axes), board_(board) {}

  /// Call it after each intended change of a setting.
  void begin_anew() {
    is_known_ = false;
    begin_pass();
  }

  /// Call it once a round of the background. Not inlined: its frame would add to that of every request.
  [[gnu::noinline]] void poll() {
    if constexpr (requires { board_.are_pins_kept(); })
      if (!board_.are_pins_kept()) has_found_ = true;
    std::size_t number = 0;
    each_setting([&](const auto& setting) {
      if (number++ == setting_) add(std::as_bytes(std::span(std::addressof(setting), 1)));
    });
    if (setting_ < number) return;
    if (is_known_ && crc_.value() != sound_) has_found_ = true;
    sound_ = crc_.value();
    is_known_ = true;
    begin_pass();
  }

  /// Whether a setting has changed without being set. Stays true until the program restarts.
  bool has_found() const { return has_found_; }

 private:
  static constexpr std::size_t kBytes = 32;

  void begin_pass() {
    crc_ = {};
    setting_ = begin_ = 0;
  }

  void add(std::span<const std::byte> bytes) {
    const std::size_t end = std::min(begin_ + kBytes, bytes.size());
    crc_.add(bytes.subspan(begin_, end - begin_));
    begin_ = end < bytes.size() ? end : 0;
    if (begin_ == 0) ++setting_;
  }

  template <typename Visit>
  void each_setting(Visit visit) const {
    visit(values_);
    visit(axes_.board().limits());
    for (std::size_t axis = 0; axis < Axes::kAxes; ++axis) {
      visit(axes_[axis].monitors().limits());
      axes_[axis].law().each_setting(visit);
    }
  }

  const ParameterValues& values_;
  const Axes& axes_;
  const Board& board_;
  Crc32 crc_;
  std::size_t setting_ = 0, begin_ = 0;  ///< where the next round continues: setting, and byte of it
  std::uint32_t sound_ = 0;
  bool is_known_ = false;
  volatile bool has_found_ = false;  // written in the background, read in the interrupt
};

}  // namespace firmware
