#include "host/record/envelope_pyramid.hpp"

#include <algorithm>
#include <bit>

namespace host {

namespace {

std::uint64_t buckets_of(std::uint64_t rows, std::size_t of_a_bucket) {
  return std::max<std::uint64_t>(1, (rows + of_a_bucket - 1) / of_a_bucket);
}

}  // namespace

EnvelopePyramid::EnvelopePyramid(std::size_t channels, std::uint64_t rows) : channels_(channels) {
  for (std::size_t of_a_bucket = kRows;; of_a_bucket *= 2) {
    const std::uint64_t buckets = buckets_of(rows, of_a_bucket);
    levels_.push_back(Envelope::empty(channels, 0, of_a_bucket, buckets));
    if (buckets == 1) return;
  }
}

std::size_t EnvelopePyramid::bytes(std::size_t channels, std::uint64_t rows) {
  return 2 * buckets_of(rows, kRows) * (2 * channels * sizeof(double) + sizeof(std::size_t));
}

/// Makes a bucket from its two halves of the level below.
void EnvelopePyramid::unite(std::size_t level, std::uint64_t bucket) {
  Envelope& whole = levels_[level];
  const Envelope& halves = levels_[level - 1];
  const std::uint64_t left = 2 * bucket, right = std::min<std::uint64_t>(left + 1, halves.taken.size() - 1);
  whole.taken[bucket] = halves.taken[left] + (right > left ? halves.taken[right] : 0);
  for (std::size_t k = 0; k < channels_; ++k) {
    whole.low[k][bucket] = std::fmin(halves.low[k][left], halves.low[k][right]);
    whole.high[k][bucket] = std::fmax(halves.high[k][left], halves.high[k][right]);
  }
}

void EnvelopePyramid::add(std::span<const Piece> pieces) {
  std::vector<std::uint64_t> changed;
  for (const Piece& piece : pieces) {
    levels_.front().widen(piece.bucket, piece.taken, piece.low, piece.high);
    changed.push_back(piece.bucket);
  }
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    for (std::uint64_t& bucket : changed) bucket /= 2;
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    for (const std::uint64_t bucket : changed) unite(level, bucket);
  }
}

Envelope EnvelopePyramid::envelope(std::uint64_t from, std::uint64_t to, std::size_t rows) const {
  const auto level =
      std::min<std::size_t>(static_cast<std::size_t>(std::countr_zero(rows / kRows)), levels_.size() - 1);
  const Envelope& whole = levels_[level];
  const std::uint64_t end = std::min<std::uint64_t>(buckets_of(to, whole.rows), whole.taken.size());
  const std::uint64_t begin = std::min(from / whole.rows, end);
  const auto part = [&](const auto& values) {
    return std::decay_t<decltype(values)>(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                          values.begin() + static_cast<std::ptrdiff_t>(end));
  };
  Envelope envelope{begin * whole.rows, whole.rows, part(whole.taken), {}, {}};
  for (std::size_t k = 0; k < channels_; ++k) {
    envelope.low.push_back(part(whole.low[k]));
    envelope.high.push_back(part(whole.high[k]));
  }
  return envelope;
}

}  // namespace host
