#include "host/evidence/record_overlap.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <set>
#include <unordered_map>

namespace host {

namespace {

constexpr std::size_t kFewestSharedRows = 50;
constexpr double kShortestOverlap_s = 0.1;
/// Least number of different readings in an interval with motion. With fewer, standstill or creep by a few encoder
/// steps could be equal by chance.
constexpr std::size_t kFewestReadings = 15;

constexpr std::vector<double> Record::*kMeasured[] = {&Record::u_V, &Record::i_A, &Record::x, &Record::w};

/// A hash of each row, equal for equal readings; 0 and -0 are equal.
std::vector<std::uint64_t> row_hashes(const Record& record) {
  std::vector<std::uint64_t> hashes(record.size(), 0x9E3779B97F4A7C15u);
  for (const auto channel : kMeasured) {
    const std::vector<double>& values = record.*channel;
    for (std::size_t k = 0; k < values.size(); ++k) {
      std::uint64_t mixed = hashes[k] ^ std::bit_cast<std::uint64_t>(values[k] + 0.0);
      mixed *= 0xFF51AFD7ED558CCDu;
      hashes[k] = mixed ^ (mixed >> 33);
    }
  }
  return hashes;
}

bool moves(const std::vector<std::uint64_t>& hashes, std::size_t begin, std::size_t length) {
  const std::set<std::uint64_t> different(hashes.begin() + static_cast<std::ptrdiff_t>(begin),
                                          hashes.begin() + static_cast<std::ptrdiff_t>(begin + length));
  return different.size() >= std::min(kFewestReadings, length);
}

}  // namespace

RecordOverlap record_overlap(const Record& first, const Record& second) {
  RecordOverlap overlap;
  for (const auto channel : kMeasured)
    if ((first.*channel).empty() != (second.*channel).empty()) return overlap;
  const auto length =
      std::max(kFewestSharedRows, static_cast<std::size_t>(std::lround(kShortestOverlap_s / second.sample_period_s)));
  if (first.size() < length || second.size() < length) return overlap;
  const std::vector<std::uint64_t> a = row_hashes(first), b = row_hashes(second);

  // Tries successive intervals of the first record, without overlap, and finds each in the second record by a rolling
  // sum.
  const auto sum_of = [&](const std::vector<std::uint64_t>& hashes, std::size_t begin) {
    std::uint64_t sum = 0;
    for (std::size_t k = begin; k < begin + length; ++k) sum += hashes[k];
    return sum;
  };
  std::unordered_multimap<std::uint64_t, std::size_t> stretches;
  for (std::size_t begin = 0; begin + length <= a.size(); begin += length)
    if (moves(a, begin, length)) stretches.emplace(sum_of(a, begin), begin);
  std::uint64_t sum = sum_of(b, 0);
  for (std::size_t begin = 0;;) {
    const auto [from, to] = stretches.equal_range(sum);
    const auto same = std::find_if(from, to, [&](const auto& stretch) {
      return std::equal(a.begin() + static_cast<std::ptrdiff_t>(stretch.second),
                        a.begin() + static_cast<std::ptrdiff_t>(stretch.second + length),
                        b.begin() + static_cast<std::ptrdiff_t>(begin));
    });
    const std::size_t step = same == to ? 1 : length;
    if (same != to) {
      if (overlap.rows == 0) overlap.begin_s = second.t_s[begin];
      overlap.rows += length;
    }
    if (begin + step + length > b.size()) break;
    if (step == 1) {
      sum += b[begin + length] - b[begin];
    } else {
      sum = sum_of(b, begin + step);
    }
    begin += step;
  }
  overlap.whole = a == b;
  return overlap;
}

}  // namespace host
