// The latest rows of a stream from a board, and envelopes of older ones, in bounded memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/record/envelope.hpp"

namespace host {

class SampleRing {
 public:
  /// Rows that are kept: ten minutes at 1 kHz. Older ones remain as envelopes of kStep rows: nine hours.
  static constexpr std::size_t kRows = 600'000, kStep = 500, kSteps = 65'536;

  explicit SampleRing(std::size_t channels, std::size_t rows = kRows, std::size_t steps = kSteps);

  /// Appends a row of the stream, whose numbers begin with 0. Rows between the previous number and this one are lost.
  /// A row that does not follow the previous one is counted as repeated and not kept.
  void append(std::uint32_t number, std::span<const double> values);

  std::uint64_t begin() const;  ///< number of the oldest row that is kept
  std::uint64_t end() const { return end_; }
  std::uint64_t lost() const { return lost_; }
  std::uint64_t repeated() const { return repeated_; }

  /// The complete buckets of `rows` rows from `from` (or the oldest known row) to `to`. Rows that are no longer kept
  /// are in buckets only if `rows` is a multiple of kStep.
  Envelope envelope(std::uint64_t from, std::uint64_t to, std::size_t rows) const;

  /// The rows of [from, to) that arrived and are kept.
  void each(std::uint64_t from, std::uint64_t to,
            const std::function<void(std::uint64_t number, std::span<const double> values)>& use) const;

 private:
  struct Step {
    std::size_t taken = 0;
    std::vector<double> low, high;
  };

  std::span<const double> row(std::uint64_t number) const;

  std::size_t channels_, rows_;
  std::vector<double> values_;  ///< row after row; row n is at n modulo rows_
  std::vector<bool> is_taken_;  ///< likewise
  std::vector<Step> steps_;     ///< step s is at s modulo their number
  std::uint64_t end_ = 0, lost_ = 0, repeated_ = 0;
};

}  // namespace host
