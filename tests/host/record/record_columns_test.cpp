// Records made of columns in memory, compared with the same numbers read from a file.
#include "host/record/record_columns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/exit_codes.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using testing::HasSubstr;

/// 3 kHz with stamps rounded to a hundredth of a millisecond, as some loggers do. The rows are even only within these
/// digits.
RecordColumns moving() {
  RecordColumns given{{{"t_s", {}}, {"u_V", {}}, {"x_m", {}}, {"v_mm_s", {}}, {"note", {}}},
                      {{"drive", "stage"}, {"sample_period_s", "0.00033333"}}};
  for (int k = 0; k < 60; ++k) {
    const double t = k / 3000.0;
    const double row[] = {std::round(t * 1e5) / 1e5, std::sin(9.0 * t), t * t / 3.0, 2e3 * t / 3.0, kNaN};
    for (std::size_t c = 0; c < 5; ++c) given.columns[c].second.push_back(row[c]);
  }
  return given;
}

std::string refusal_of(const RecordColumns& given) {
  try {
    record_of(given, "mine");
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code, ExitCode::bad_input);
    return failure.what();
  }
  return "";
}

TEST(RecordColumns, AreTheRecordThatTheirFileHolds) {
  const Record record = record_of(moving(), "mine");
  const Record again = parse_record(format_record(record), "file");
  EXPECT_EQ(record.sample_period_s, 0.00033333);
  EXPECT_EQ(record.kind, sim::DriveKind::linear);
  EXPECT_EQ(record.drive, "stage");
  for (const auto channel : {&Record::t_s, &Record::u_V, &Record::x, &Record::w})
    EXPECT_EQ(record.*channel, again.*channel);
  EXPECT_EQ(columns_of(record).columns[2].second, moving().columns[2].second);
  EXPECT_TRUE(std::isnan(record.extra.at(0).values[7]));
}

TEST(RecordColumns, AreRefusedByRowColumnAndRemedy) {
  RecordColumns given = moving();
  given.columns[2].second[7] = kNaN;
  EXPECT_THAT(refusal_of(given), HasSubstr("mine: row 7, column x_m: nan is not a measured value; correct it"));
  given = moving();
  given.columns[1].second.pop_back();
  EXPECT_THAT(refusal_of(given), HasSubstr("t_s has 60 rows, u_V has 59"));
  given = moving();
  given.header["sample_period_s"] = "0.001";
  EXPECT_THAT(refusal_of(given), HasSubstr("mine: sample_period_s: 0.001 s contradicts t_s"));
  given = moving();
  given.header["format"] = "axis-record/2";
  EXPECT_THAT(refusal_of(given), HasSubstr("format 'axis-record/2' is unknown"));
  given = moving();
  for (auto& [name, values] : given.columns) values.resize(19);
  EXPECT_THAT(refusal_of(given), HasSubstr("ends after 19 rows"));
}

}  // namespace

}  // namespace host
