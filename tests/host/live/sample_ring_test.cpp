// Rows of a stream in bounded memory: none is lost or doubled unnoticed, and envelopes keep every extreme.
#include "host/live/sample_ring.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace {

using host::Envelope;
using host::SampleRing;

void append(SampleRing& ring, std::uint32_t number, double first, double second = 0.0) {
  ring.append(number, std::array{first, second});
}

std::size_t count_of(const SampleRing& ring, std::uint64_t from, std::uint64_t to) {
  std::size_t count = 0;
  ring.each(from, to, [&](std::uint64_t, std::span<const double>) { ++count; });
  return count;
}

TEST(SampleRing, CountsLostAndRepeatedRowsAndKeepsTheGap) {
  SampleRing ring(2, 100);
  for (const std::uint32_t number : {2U, 3U, 6U, 6U, 5U, 7U}) append(ring, number, number, -1.0 * number);
  EXPECT_EQ(ring.end(), 8U);
  EXPECT_EQ(ring.lost(), 4U) << "0, 1, 4 and 5";
  EXPECT_EQ(ring.repeated(), 2U);
  const Envelope envelope = ring.envelope(0, 8, 2);
  EXPECT_EQ(envelope.taken, (std::vector<std::size_t>{0, 2, 0, 2}));
  EXPECT_TRUE(std::isnan(envelope.low[0][2])) << "a gap stays a gap";
  EXPECT_EQ(envelope.low[0][3], 6.0);
  EXPECT_EQ(envelope.high[0][3], 7.0);
  EXPECT_EQ(envelope.low[1][3], -7.0);
  EXPECT_EQ(count_of(ring, 0, 8), 4U);
  EXPECT_EQ(count_of(ring, 4, 7), 1U);
}

TEST(SampleRing, OverwritesTheOldestRows) {
  SampleRing ring(2, 100);
  for (std::uint32_t number = 0; number < 250; ++number) append(ring, number, number);
  EXPECT_EQ(ring.begin(), 150U);
  EXPECT_EQ(count_of(ring, 0, 1000), 100U);
  const Envelope envelope = ring.envelope(0, 250, 30);
  EXPECT_EQ(envelope.first, 150U);
  EXPECT_EQ(envelope.taken, (std::vector<std::size_t>{30, 30, 30})) << "only complete buckets";
  EXPECT_EQ(envelope.low[0].front(), 150.0);
  append(ring, 1'000'000, 1.0);  // longer than the ring
  EXPECT_EQ(count_of(ring, 0, ring.end()), 1U);
  EXPECT_EQ(ring.lost(), 1'000'000U - 250U);
}

TEST(SampleRing, StepsOutliveTheRowsAndKeepEveryExtreme) {
  constexpr std::uint32_t kRows = 20 * SampleRing::kStep;
  SampleRing ring(2, 1000, 30);
  for (std::uint32_t number = 0; number < kRows; ++number)
    if (number != 1234) append(ring, number, number == 777 ? 5.0 : 0.0, number == 778 ? -5.0 : 0.0);
  const Envelope envelope = ring.envelope(0, kRows, 2 * SampleRing::kStep);
  ASSERT_EQ(envelope.taken.size(), 10U);
  EXPECT_EQ(envelope.high[0][0], 5.0);
  EXPECT_EQ(envelope.low[1][0], -5.0);
  EXPECT_EQ(envelope.high[0][1], 0.0);
  EXPECT_EQ(envelope.taken[0], 2 * SampleRing::kStep);
  EXPECT_EQ(envelope.taken[1], 2 * SampleRing::kStep - 1);
  EXPECT_TRUE(ring.envelope(0, 999, 10).taken.empty()) << "rows that are gone are in no finer bucket";
}

TEST(SampleRing, StepsAreReusedInTheirTurn) {
  SampleRing ring(2, 100, 4);
  for (std::uint32_t number = 0; number < 10 * SampleRing::kStep; ++number) append(ring, number, number);
  const Envelope envelope = ring.envelope(0, ring.end(), SampleRing::kStep);
  ASSERT_EQ(envelope.taken.size(), 3U);
  EXPECT_EQ(envelope.first, 7 * SampleRing::kStep);
  EXPECT_EQ(envelope.low[0][0], 7.0 * SampleRing::kStep);
}

TEST(SampleRing, ContinuesBeyondThe32BitsOfTheBoardsNumbers) {
  SampleRing ring(2, 10);
  for (const std::uint32_t number : {0x7FFF'0000U, 0xFFFE'0000U, 0xFFFF'FFFEU, 0xFFFF'FFFFU, 0U, 1U})
    append(ring, number, 1.0);
  EXPECT_EQ(ring.end(), 0x1'0000'0002ULL);
  EXPECT_EQ(ring.repeated(), 0U);
  EXPECT_EQ(count_of(ring, ring.begin(), ring.end()), 4U);
}

}  // namespace
