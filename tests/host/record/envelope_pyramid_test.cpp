// The picture of a range is the range's extremes: no peak is lost, none is invented, and gaps stay gaps.
#include "host/record/envelope_pyramid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using host::Envelope;
using host::EnvelopePyramid;

struct Rows {
  std::vector<double> first, second;
  std::vector<bool> is_there;
};

/// Rows of which some are lost, and values of which some are no numbers.
Rows random_rows(std::size_t count) {
  std::mt19937 random(7);
  std::normal_distribution<double> value;
  Rows rows;
  for (std::size_t k = 0; k < count; ++k) {
    rows.first.push_back(value(random));
    rows.second.push_back(k % 1000 > 300 && k % 1000 < 520 ? std::nan("") : value(random));
    rows.is_there.push_back(k < 2000 || k > 2600);
  }
  return rows;
}

void add(const Rows& rows, std::size_t begin, std::size_t end, EnvelopePyramid& pyramid) {
  std::vector<EnvelopePyramid::Piece> pieces;
  for (std::size_t k = begin; k < end; ++k)
    if (rows.is_there[k])
      pieces.push_back(
          {k / EnvelopePyramid::kRows, 1, {rows.first[k], rows.second[k]}, {rows.first[k], rows.second[k]}});
  pyramid.add(pieces);
}

void expect_extremes(const Rows& rows, const Envelope& envelope) {
  for (std::size_t bucket = 0; bucket < envelope.taken.size(); ++bucket) {
    const std::size_t begin = envelope.first + bucket * envelope.rows;
    std::size_t taken = 0;
    double low = std::nan(""), high = low, low_2 = low, high_2 = low;
    for (std::size_t k = begin; k < std::min(begin + envelope.rows, rows.first.size()); ++k) {
      if (!rows.is_there[k]) continue;
      ++taken;
      low = std::fmin(low, rows.first[k]);
      high = std::fmax(high, rows.first[k]);
      low_2 = std::fmin(low_2, rows.second[k]);
      high_2 = std::fmax(high_2, rows.second[k]);
    }
    const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    ASSERT_EQ(envelope.taken[bucket], taken) << "from row " << begin << ", " << envelope.rows << " rows";
    ASSERT_TRUE(same(envelope.low[0][bucket], low) && same(envelope.high[0][bucket], high)) << begin;
    ASSERT_TRUE(same(envelope.low[1][bucket], low_2) && same(envelope.high[1][bucket], high_2)) << begin;
  }
}

TEST(EnvelopePyramid, AnyRangeAtAnyScaleHasTheExtremesOfItsRows) {
  const Rows rows = random_rows(10'007);
  EnvelopePyramid pyramid(2, rows.first.size());
  for (const std::size_t block : {3U, 0U, 4U, 2U, 1U})
    add(rows, block * 2500, std::min<std::size_t>((block + 1) * 2500, 10'007), pyramid);
  for (std::size_t scale = 64; scale <= 16'384; scale *= 2)
    for (const auto& [from, to] : std::vector<std::pair<std::size_t, std::size_t>>{
             {0, 10'007}, {63, 64}, {64, 65}, {1990, 2700}, {9999, 10'007}, {10'000, 99'999}}) {
      const Envelope envelope = pyramid.envelope(from, to, scale);
      ASSERT_LE(envelope.first, from);
      ASSERT_GE(envelope.first + envelope.taken.size() * envelope.rows, std::min<std::size_t>(to, 10'007));
      ASSERT_LE(envelope.taken.size(), (std::min<std::size_t>(to, 10'007) - from) / envelope.rows + 2);
      expect_extremes(rows, envelope);
    }
}

TEST(EnvelopePyramid, WhatLiesBeyondTheRecordIsEmpty) {
  EnvelopePyramid pyramid(1, 100);
  EXPECT_TRUE(pyramid.envelope(5000, 6000, 64).taken.empty());
  EXPECT_EQ(pyramid.envelope(0, 100, 64).taken, (std::vector<std::size_t>{0, 0})) << "nothing has been read yet";
  EXPECT_EQ(pyramid.envelope(0, 100, std::size_t{1} << 40U).taken.size(), 1U);
}

}  // namespace
