// Extremes of channels in buckets of rows, from which a picture of many rows is drawn.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace host {

/// Extremes of each channel in buckets of equal numbers of rows.
struct Envelope {
  std::uint64_t first = 0;                     ///< number of the first row of the first bucket, a multiple of `rows`
  std::size_t rows = 1;                        ///< of a bucket
  std::vector<std::size_t> taken;              ///< rows that arrived, of each bucket
  std::vector<std::vector<double>> low, high;  ///< of each channel and bucket; NaN if no value arrived

  /// `buckets` empty buckets from row `first_row`.
  static Envelope empty(std::size_t channels, std::uint64_t first_row, std::size_t rows, std::size_t buckets) {
    Envelope envelope{first_row, rows, std::vector<std::size_t>(buckets), {}, {}};
    envelope.low.assign(channels, std::vector<double>(buckets, std::nan("")));
    envelope.high = envelope.low;
    return envelope;
  }

  /// Adds rows with these extremes to a bucket. NaN adds nothing to its channel.
  void widen(std::size_t bucket, std::size_t added, std::span<const double> lowest, std::span<const double> highest) {
    if (added == 0) return;
    taken[bucket] += added;
    for (std::size_t k = 0; k < lowest.size(); ++k) {
      low[k][bucket] = std::fmin(low[k][bucket], lowest[k]);
      high[k][bucket] = std::fmax(high[k][bucket], highest[k]);
    }
  }
};

}  // namespace host
