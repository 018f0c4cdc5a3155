// A picture of a file has each row at its time, from whichever thread and block it came.
#include "host/record/record_picture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "host/exit_codes.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using host::Envelope;
using host::RecordPicture;

constexpr std::size_t kRows = 60'000;  // several blocks
constexpr double kLongest_s = 60.0;

double wave(std::size_t row) { return std::sin(static_cast<double>(row) * 0.01) * 10.0; }

std::string row_text(std::size_t row) {
  return fmt::format("{:.3f},{:.6f},{}\n", 5.0 + 0.001 * static_cast<double>(row), wave(row), row % 7);
}

std::string record_text(const std::function<std::string(std::size_t)>& line = row_text) {
  std::string text = "# format: axis-record/1\n# drive: x\nt_s,u_V,x_mm\n";
  for (std::size_t row = 0; row < kRows; ++row) text += line(row);
  return text;
}

std::string refusal_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const host::Failure& failure) {
    return failure.what();
  }
  return "accepted";
}

TEST(RecordPicture, EveryBucketHasTheExtremesOfItsRows) {
  const TemporaryFolder folder;
  const RecordPicture picture(folder.write("long.csv", record_text()));
  picture.wait(kLongest_s);
  EXPECT_GT(picture.file().blocks(), 4U);
  EXPECT_EQ(picture.progress().share, 1.0);
  EXPECT_EQ(picture.file().rows(), kRows);
  EXPECT_NEAR(picture.file().period_s(), 0.001, 1e-12);
  EXPECT_EQ(picture.file().start_s(), 5.0);
  for (const auto& [from, to, points] : std::vector<std::array<std::size_t, 3>>{
           {0, kRows, 100}, {0, kRows, 4000}, {12'345, 45'678, 1000}, {30'001, 30'011, 1000}, {59'990, 99'999, 7}}) {
    const Envelope envelope = picture.envelope(from, to, points);
    const std::size_t end = std::min(to, kRows);
    ASSERT_LE(envelope.taken.size(), points + 2);
    ASSERT_LE(envelope.first, from);
    ASSERT_GE(envelope.first + envelope.taken.size() * envelope.rows, end);
    for (std::size_t bucket = 0; bucket < envelope.taken.size(); ++bucket) {
      const std::size_t begin = envelope.first + bucket * envelope.rows, stop = std::min(begin + envelope.rows, kRows);
      ASSERT_EQ(envelope.taken[bucket], stop - begin) << begin;
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (std::size_t row = begin; row < stop; ++row) {
        low = std::min(low, wave(row));
        high = std::max(high, wave(row));
      }
      ASSERT_NEAR(envelope.low[0][bucket], low, 1e-6) << begin;
      ASSERT_NEAR(envelope.high[0][bucket], high, 1e-6) << begin;
    }
  }
}

TEST(RecordPicture, ShowsGapsAndWhatIsNoNumberAsMissing) {
  const TemporaryFolder folder;
  const RecordPicture picture(folder.write("gap.csv", record_text([](std::size_t row) -> std::string {
                                             if (row >= 20'000 && row < 20'400) return "";  // lost
                                             if (row == 30'000) return "35.000,nan,1\n";    // no number
                                             if (row == 30'001) return "35.001,1\n";        // cut off
                                             if (row == 30'002) return "12.000,99,1\n";     // back in time
                                             if (row == 30'003) return "35.003,,3\r\n";     // empty field
                                             return row_text(row);
                                           })));
  picture.wait(kLongest_s);
  EXPECT_EQ(picture.file().rows(), kRows) << "the gap takes its time";
  const Envelope gap = picture.envelope(19'968, 20'480, 8);
  ASSERT_EQ(gap.rows, 64U);
  EXPECT_THAT(gap.taken, testing::ElementsAre(32, 0, 0, 0, 0, 0, 16, 64));
  EXPECT_TRUE(std::isnan(gap.low[0][1]));
  const Envelope rows = picture.envelope(30'000, 30'004, 4);
  EXPECT_THAT(rows.taken, testing::ElementsAre(1, 0, 0, 1));
  EXPECT_TRUE(std::isnan(rows.low[0][0]) && std::isnan(rows.high[0][3]));
  EXPECT_EQ(rows.low[1][0], 1.0);
  EXPECT_EQ(picture.progress().faults.rows, 2U);
  EXPECT_EQ(picture.progress().faults.fields, 2U);
}

TEST(RecordPicture, RoundedStampsDoNotAddUp) {
  const TemporaryFolder folder;
  const RecordPicture picture(folder.write("third.csv", record_text([](std::size_t row) {
                                             return fmt::format("{:.4f},{},0\n", static_cast<double>(row) / 3000.0,
                                                                row == 50'000 ? 1 : 0);
                                           })));
  picture.wait(kLongest_s);
  EXPECT_EQ(picture.file().rows(), kRows);
  const Envelope envelope = picture.envelope(49'999, 50'002, 3);
  EXPECT_THAT(envelope.taken, testing::Each(1U));
  EXPECT_EQ(envelope.high[0][50'000 - envelope.first], 1.0);
}

TEST(RecordPicture, RefusesAFileThatChangedAndOneThatIsNone) {
  const TemporaryFolder folder;
  const std::string path = folder.write("long.csv", record_text());
  const RecordPicture picture(path);
  picture.wait(kLongest_s);
  std::ofstream(path, std::ios::app) << "65.000,1,1\n";
  EXPECT_THAT(refusal_of([&] { picture.envelope(100, 200, 100); }), testing::HasSubstr("has changed"));
  std::filesystem::resize_file(path, 1000);
  EXPECT_THAT(refusal_of([&] { picture.text_of(0, 1000); }), testing::HasSubstr("has changed"));
  const auto refused = [&](const std::string& text) {
    return refusal_of([&] { RecordPicture(folder.write("x.csv", text)); });
  };
  EXPECT_THAT(refused(""), testing::HasSubstr("column names"));
  EXPECT_THAT(refused("u_V,x_mm\n1,2\n"), testing::HasSubstr("t_s"));
  EXPECT_THAT(refused("t_s,u_V\n"), testing::HasSubstr("no rows"));
  EXPECT_THAT(refused("t_s,u_V\n0,1\n1,2\n"), testing::HasSubstr("fewer than 20 rows"));
  std::string still = "t_s,u_V\n", far = still;
  for (int row = 0; row < 100; ++row) {
    still += "1.0,2\n";
    far += fmt::format("{},1\n", row < 99 ? 1e-6 * row : 1e6);
  }
  EXPECT_THAT(refused(still), testing::HasSubstr("does not increase"));
  EXPECT_THAT(refused(far), testing::HasSubstr("cut it at the gap"));
  EXPECT_THAT(refused("t_s," + std::string(2 << 20, 'x')), testing::Not("accepted"));
}

TEST(RecordPicture, TheTextOfAPartHoldsItsRows) {
  const TemporaryFolder folder;
  const RecordPicture picture(folder.write("long.csv", record_text()));
  picture.wait(kLongest_s);
  const std::string text = picture.text_of(40'000, 40'010);
  EXPECT_TRUE(text.starts_with("# format: axis-record/1\n# drive: x\nt_s,u_V,x_mm\n"));
  for (std::size_t row = 40'000; row < 40'010; ++row)
    EXPECT_NE(text.find("\n" + row_text(row)), std::string::npos) << row;
  EXPECT_LT(text.size(), 3 * host::RecordFile::kBlock);
}

}  // namespace
