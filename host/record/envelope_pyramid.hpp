// Envelopes of a long record at every scale. Rows may come in any order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/record/envelope.hpp"

namespace host {

class EnvelopePyramid {
 public:
  /// Rows of a bucket of the finest level. Each further level has half as many buckets as the level below it.
  static constexpr std::size_t kRows = 64;

  /// Successive rows of one bucket of the finest level: extremes of each channel, NaN if it has no value.
  struct Piece {
    std::uint64_t bucket = 0;
    std::size_t taken = 0;
    std::vector<double> low, high;
  };

  /// For rows 0 to `rows` - 1.
  EnvelopePyramid(std::size_t channels, std::uint64_t rows);

  void add(std::span<const Piece> pieces);

  /// The buckets of `rows` rows, a power of two and at least kRows, that overlap [from, to) and begin within the
  /// record.
  Envelope envelope(std::uint64_t from, std::uint64_t to, std::size_t rows) const;

  /// Memory that a pyramid takes.
  static std::size_t bytes(std::size_t channels, std::uint64_t rows);

 private:
  void unite(std::size_t level, std::uint64_t bucket);

  std::size_t channels_;
  std::vector<Envelope> levels_;
};

}  // namespace host
