// Queue of samples from the control interrupt to the host: selected channels, at loop rate, with a count of lost rows.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "firmware/app/channel_words.hpp"

namespace firmware {

/// One writer (take, in the control interrupt) and one reader (the other functions, in the background). If there is no
/// room, the newest row is dropped, but its number is still counted.
class CaptureStream {
 public:
  static constexpr std::size_t kRows = 64;  ///< allowed delay of the background: 64 ms at 1 kHz

  /// Call it while the control interrupt is disabled. At least one channel and at most kWordsPerReport, every >= 1.
  void start(const CaptureRequest& request) {
    channels_ = request.channels;
    words_ = request.words();
    every_ = request.every;
    until_next_ = 1;
    rows_taken_ = 0;
    dropped_ = 0;
    written_.store(0);
    read_.store(0);
    is_running_ = true;
  }
  void stop() { is_running_ = false; }

  bool is_running() const { return is_running_; }
  std::size_t words_per_row() const { return words_; }
  CaptureReply counts() const { return {rows_taken_, dropped_}; }

  /// Once a control period, after the axes' steps. `axes`: an AxisGroup that has all requested axes.
  template <typename Axes>
  void take(const Axes& axes) {
    if (!is_running_ || --until_next_ > 0) return;
    until_next_ = every_;
    const std::uint32_t number = rows_taken_;
    rows_taken_ = number + 1;
    const std::uint32_t written = written_.load(std::memory_order_relaxed);
    if (written - read_.load(std::memory_order_acquire) == kRows) {
      dropped_ = dropped_ + 1;
      return;
    }
    Row& row = rows_[written % kRows];
    row.number = number;
    std::size_t used = 0;
    for (std::size_t axis = 0; axis < Axes::kAxes; ++axis)
      for (std::uint32_t left = channels_[axis]; left != 0; left &= left - 1)
        row.word[used++] = channel_word(axes[axis], static_cast<Channel>(std::countr_zero(left)));
    written_.store(written + 1, std::memory_order_release);
  }

  /// Takes the next rows with consecutive numbers that fit one report. `only_full`: only if they fill the report.
  /// Returns 0 if there is nothing to send.
  std::size_t fetch(SamplesPayload& payload, bool only_full) {
    const std::uint32_t read = read_.load(std::memory_order_relaxed);
    const std::uint32_t waiting = written_.load(std::memory_order_acquire) - read;
    if (waiting == 0 || words_ == 0) return 0;
    const std::size_t room = kWordsPerReport / words_;
    payload = {};
    payload.first_row = rows_[read % kRows].number;
    std::uint32_t rows = 0;
    while (rows < waiting && rows < room && rows_[(read + rows) % kRows].number == payload.first_row + rows) ++rows;
    const bool is_cut = rows < room && rows < waiting;  // a gap follows: no more rows fit this report
    if (only_full && rows < room && !is_cut) return 0;
    for (std::uint32_t i = 0; i < rows; ++i)
      for (std::size_t word = 0; word < words_; ++word)
        payload.word[i * words_ + word] = rows_[(read + i) % kRows].word[word];
    read_.store(read + rows, std::memory_order_release);
    return rows;
  }

 private:
  struct Row {
    std::uint32_t number = 0;
    std::array<std::uint32_t, kWordsPerReport> word{};
  };

  std::array<Row, kRows> rows_{};
  std::atomic<std::uint32_t> written_ = 0;
  std::atomic<std::uint32_t> read_ = 0;
  std::array<std::uint16_t, hal::kMostAxes> channels_{};
  std::size_t words_ = 0;
  std::int32_t every_ = 1;
  std::int32_t until_next_ = 1;
  volatile std::uint32_t rows_taken_ = 0;  // written in the interrupt, read in the background
  volatile std::uint32_t dropped_ = 0;
  volatile bool is_running_ = false;
};

}  // namespace firmware
