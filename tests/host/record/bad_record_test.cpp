// One test for each possible fault of a record. The message must contain file, line, column and remedy.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "host/exit_codes.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/read_record.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Rows of a record in which the axis moves back and forth: u in V, x in mm, w in rad/s, 1 kHz, lead 2 mm/rad.
constexpr double kLead = 2.0;
struct Row {
  double t_s, u_V, x_mm, w_rad_s;
};

Row swing(int k) {
  const double t = 0.001 * k;
  return {t, 3.0 * std::cos(20.0 * t) + 0.1 * (k % 3), std::round(kLead * std::sin(20.0 * t) / 0.001) * 0.001,
          20.0 * std::cos(20.0 * t)};
}

constexpr const char* kHeader = "# format: axis-record/1\n# drive: x\n# sample_period_s: 0.001\n";

std::string rows_of(int count, const std::function<std::string(int, Row)>& line) {
  std::string text;
  for (int k = 0; k < count; ++k) text += line(k, swing(k)) + "\n";
  return text;
}

std::string plain(int, Row r) { return fmt::format("{},{},{},{}", r.t_s, r.u_V, r.x_mm, r.w_rad_s); }

std::string good_text(int count = 1000) {
  return std::string(kHeader) + "t_s,u_V,x_mm,w_rad_s\n" + rows_of(count, plain);
}

class BadRecord : public testing::Test {
 protected:
  /// The message for a file with `text`. The exit code must be that of a bad input file.
  std::string message_of(const std::string& text, const std::function<void(host::Record&)>& then = {}) {
    const std::string path = folder.write("measured.csv", text);
    try {
      host::Record record = host::read_record(path);
      if (then) then(record);
    } catch (const host::Failure& failure) {
      EXPECT_EQ(failure.code, host::ExitCode::bad_input);
      EXPECT_THAT(failure.what(), HasSubstr(path));
      return failure.what();
    }
    return "no failure";
  }

  /// The good record with one line changed (1 is the first line of the file).
  std::string with_line(int number, const std::string& replacement) {
    std::string text = good_text();
    std::size_t start = 0;
    for (int k = 1; k < number; ++k) start = text.find('\n', start) + 1;
    return text.replace(start, text.find('\n', start) - start, replacement);
  }

  TemporaryFolder folder;
};

TEST_F(BadRecord, GoodRecordIsRead) { EXPECT_EQ(message_of(good_text()), "no failure"); }

TEST_F(BadRecord, AbsentFile) {
  try {
    host::read_record(folder.path("absent.csv"));
    FAIL();
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), AllOf(HasSubstr("absent.csv"), HasSubstr("No such file")));
  }
}

TEST_F(BadRecord, Empty) {
  EXPECT_THAT(message_of(""), HasSubstr("the file is empty"));
  EXPECT_THAT(message_of("\n\n"), HasSubstr("the file is empty"));
  EXPECT_THAT(message_of(kHeader), HasSubstr("the line with the column names is missing"));
  EXPECT_THAT(message_of(std::string(kHeader) + "t_s,u_V,x_mm\n"), AllOf(HasSubstr("line 4"), HasSubstr("no rows")));
}

TEST_F(BadRecord, UnknownFormat) {
  EXPECT_THAT(message_of(with_line(1, "# format: axis-record/7")),
              AllOf(HasSubstr("line 1"), HasSubstr("axis-record/7"), HasSubstr("reads axis-record/1")));
  EXPECT_THAT(message_of(with_line(1, "# remark")), AllOf(HasSubstr("# format: axis-record/1"), HasSubstr("import")));
}

TEST_F(BadRecord, MissingColumn) {
  EXPECT_THAT(message_of(with_line(4, "t_ms,u_V,x_mm,w_rad_s")),
              AllOf(HasSubstr("line 4"), HasSubstr("missing column: t_s"), HasSubstr("t_ms"), HasSubstr("--map")));
  EXPECT_THAT(message_of(with_line(4, "t_s,volts,x_mm,w_rad_s")), HasSubstr("missing column: u_V"));
  EXPECT_THAT(message_of(with_line(4, "t_s,u_V,position,speed")), HasSubstr("missing column: a position"));
}

TEST_F(BadRecord, NoColumnNames) {
  EXPECT_THAT(message_of(std::string(kHeader) + "0,1,2,3\n"), AllOf(HasSubstr("line 4"), HasSubstr("column names")));
}

TEST_F(BadRecord, WrongNumberOfFields) {
  EXPECT_THAT(message_of(with_line(10, "0.005,1,2")),
              AllOf(HasSubstr("line 10"), HasSubstr("3 where line 4 names 4 columns"), HasSubstr("correct")));
  EXPECT_THAT(message_of(with_line(10, "0.005,1,2,3,4")), HasSubstr("5 where line 4 names 4 columns"));
  EXPECT_THAT(message_of(with_line(1004, "0.999,1")), HasSubstr("cut off: remove it"));
}

TEST_F(BadRecord, UnparsableNumber) {
  EXPECT_THAT(message_of(with_line(10, "0.005,abc,2,3")),
              AllOf(HasSubstr("line 10"), HasSubstr("column 2 (u_V)"), HasSubstr("'abc' is not a number"),
                    HasSubstr("cut the record")));
  EXPECT_THAT(message_of(with_line(10, "0.005,1,,3")), AllOf(HasSubstr("column 3 (x_mm)"), HasSubstr("empty")));
  EXPECT_THAT(message_of(with_line(10, "0.005,1,2 mm,3")), HasSubstr("'2 mm' is not a number"));
  EXPECT_THAT(message_of(with_line(10, "0.005,1,2,1e999")), HasSubstr("column 4 (w_rad_s)"));
}

TEST_F(BadRecord, NotFinite) {
  EXPECT_THAT(message_of(with_line(10, "0.005,1,NaN,3")),
              AllOf(HasSubstr("line 10"), HasSubstr("column 3 (x_mm)"), HasSubstr("NaN")));
  EXPECT_THAT(message_of(with_line(10, "0.005,-inf,2,3")), AllOf(HasSubstr("column 2 (u_V)"), HasSubstr("infinite")));
}

TEST_F(BadRecord, BlankAndCommentLinesAmongRows) {
  EXPECT_THAT(message_of(with_line(10, "")), AllOf(HasSubstr("line 10"), HasSubstr("blank")));
  EXPECT_THAT(message_of(with_line(10, "# pause")), AllOf(HasSubstr("line 10"), HasSubstr("move it to the top")));
}

TEST_F(BadRecord, TimeDoesNotIncrease) {
  EXPECT_THAT(message_of(with_line(10, "0.004,1,2,3")),
              AllOf(HasSubstr("line 10, column t_s"), HasSubstr("does not increase"), HasSubstr("remove")));
}

TEST_F(BadRecord, PeriodContradictsHeader) {
  EXPECT_THAT(
      message_of(with_line(3, "# sample_period_s: 0.0005")),
      AllOf(HasSubstr("line 3"), HasSubstr("0.0005 s contradicts t_s"), HasSubstr("0.001 s"), HasSubstr("correct")));
  EXPECT_THAT(message_of(with_line(3, "# sample_period_s: 1 ms")),
              AllOf(HasSubstr("line 3"), HasSubstr("'1 ms' is not a positive number")));
}

TEST_F(BadRecord, DroppedSamples) {
  const std::string text = std::string(kHeader) + "t_s,u_V,x_mm,w_rad_s\n" + rows_of(1000, [](int k, Row r) {
                             if (k >= 300) r = swing(k + 4);
                             return plain(k, r);
                           });
  EXPECT_THAT(message_of(text), AllOf(HasSubstr("line 305, column t_s"), HasSubstr("dropped samples"),
                                      HasSubstr("4 sample(s) missing"), HasSubstr("--resample 0.001")));
}

TEST_F(BadRecord, Jitter) {
  const std::string text = std::string(kHeader) + "t_s,u_V,x_mm,w_rad_s\n" + rows_of(1000, [](int k, Row r) {
                             r.t_s += k % 2 == 0 ? 0.00005 : 0.0;
                             return plain(k, r);
                           });
  EXPECT_THAT(message_of(text), AllOf(HasSubstr("column t_s"), HasSubstr("0.05 ms rms"), HasSubstr("--resample")));
}

TEST_F(BadRecord, TooShort) {
  EXPECT_THAT(message_of(good_text(19)),
              AllOf(HasSubstr("line 23"), HasSubstr("19 rows, too short"), HasSubstr("longer")));
  EXPECT_EQ(message_of(good_text(20)), "no failure");
}

TEST_F(BadRecord, TooShortOrTooSlowForWhatIsAsked) {
  EXPECT_THAT(message_of(good_text(), [](host::Record& r) { host::require_duration(r, 2.0, "tell friction apart"); }),
              AllOf(HasSubstr("line 4, column t_s: the record lasts 1 s"),
                    HasSubstr("too short to tell friction apart"), HasSubstr("record 2 s")));
  EXPECT_THAT(message_of(good_text(), [](host::Record& r) { host::require_rate(r, 4000.0, "see the current loop"); }),
              AllOf(HasSubstr("line 4, column t_s: sampled at 1000 Hz"), HasSubstr("too slow to see the current loop"),
                    HasSubstr("4000 Hz")));
}

TEST_F(BadRecord, DuplicatedChannel) {
  EXPECT_THAT(message_of(with_line(4, "t_s,u_V,u_V,x_mm")),
              AllOf(HasSubstr("line 4"), HasSubstr("duplicated channel"), HasSubstr("u_V"), HasSubstr("keep one")));
  EXPECT_THAT(message_of(with_line(4, "t_s,u_V,x_mm,x_m")), AllOf(HasSubstr("line 4"), HasSubstr("same quantity")));
  EXPECT_THAT(message_of(with_line(4, "t_s,u_V,v_m_s,w_ref_rad_s")), HasSubstr("different kinds of drive"));
  const std::string copied = std::string(kHeader) + "t_s,u_V,x_mm,w_rad_s\n" + rows_of(500, [](int, Row r) {
                               return fmt::format("{},{},{},{}", r.t_s, r.u_V, r.w_rad_s, r.w_rad_s);
                             });
  EXPECT_THAT(message_of(copied),
              AllOf(HasSubstr("duplicated channel"), HasSubstr("x_mm and w_rad_s"), HasSubstr("remove the copy")));
}

std::string with_columns(const std::function<void(int, Row&)>& change, int count = 1000,
                         const char* names = "t_s,u_V,x_mm,w_rad_s") {
  return std::string(kHeader) + names + "\n" + rows_of(count, [&](int k, Row r) {
           change(k, r);
           return plain(k, r);
         });
}

TEST_F(BadRecord, DeadChannel) {
  EXPECT_THAT(message_of(with_columns([](int, Row& r) { r.w_rad_s = 0.0; })),
              AllOf(HasSubstr("line 4, column w_rad_s"), HasSubstr("dead channel"), HasSubstr("x_mm shows motion"),
                    HasSubstr("leave the column out")));
  EXPECT_THAT(message_of(with_columns([](int, Row& r) { r.w_rad_s = 4.2; })), HasSubstr("column w_rad_s: dead"));
  EXPECT_THAT(message_of(with_columns([](int, Row& r) { r.x_mm = 7.5; })),
              AllOf(HasSubstr("column x_mm: dead channel"), HasSubstr("w_rad_s shows motion")));
  EXPECT_THAT(message_of(with_columns([](int, Row& r) { r.u_V = 0.0; })),
              AllOf(HasSubstr("column u_V: dead channel"), HasSubstr("moves in both directions")));
  EXPECT_THAT(message_of(with_columns([](int, Row& r) { r.u_V = 3.1; })), HasSubstr("column u_V: dead channel"));
}

TEST_F(BadRecord, NoCommandWhileTheAxisSpeedsUp) {
  EXPECT_THAT(message_of(with_columns([](int k, Row& r) {
                r.u_V = 0.0;
                r.w_rad_s = 0.02 * k;
                r.x_mm = std::round(0.00001 * kLead * k * k * 1000.0) / 1000.0;
              })),
              AllOf(HasSubstr("column u_V: dead channel"), HasSubstr("accelerates")));
}

TEST_F(BadRecord, ConstantChannelsThatAreLegal) {
  const auto noise = [](int k) { return 0.1 * std::sin(1e4 * k * k); };
  // Standstill, for a measurement of noise.
  EXPECT_EQ(message_of(with_columns([&](int k, Row& r) { r = {r.t_s, 0.0, 0.0, noise(k)}; })), "no failure");
  // The axis never breaks away, although the command alternates.
  EXPECT_EQ(message_of(with_columns([&](int k, Row& r) {
              r = {r.t_s, k / 100 % 2 ? 1.0 : -1.0, 0.0, noise(k)};
            })),
            "no failure");
  // Coast-down: no command, and the speed decreases.
  EXPECT_EQ(message_of(with_columns([](int k, Row& r) {
              const double w = 30.0 * std::exp(-0.005 * k);
              r = {r.t_s, 0.0, std::round(kLead * 6.0 * (1.0 - std::exp(-0.005 * k)) * 1000.0) / 1000.0, w};
            })),
            "no failure");
  // Step response: a constant command, starting at rest.
  EXPECT_EQ(message_of(with_columns([](int k, Row& r) {
              const double a = std::exp(-0.005 * k);
              r = {r.t_s, 2.0, std::round(kLead * (0.03 * k - 6.0 * (1.0 - a)) * 1000.0) / 1000.0, 30.0 * (1.0 - a)};
            })),
            "no failure");
}

TEST_F(BadRecord, CommandInCountsOrMillivolts) {
  EXPECT_THAT(
      message_of(with_columns([](int, Row& r) { r.u_V = std::round(r.u_V * 3276.8); })),
      AllOf(HasSubstr("line 5, column u_V"), HasSubstr("cannot be right"), HasSubstr("counts"), HasSubstr("--map")));
}

TEST_F(BadRecord, SpeedOfALinearDriveInTheWrongUnit) {
  const auto linear = [](double factor) {
    return with_columns([=](int, Row& r) { r.w_rad_s *= kLead * factor; }, 1000, "t_s,u_V,x_mm,v_mm_s");
  };
  EXPECT_EQ(message_of(linear(1.0)), "no failure");
  EXPECT_EQ(message_of(linear(1.1)), "no failure");
  EXPECT_THAT(message_of(linear(0.001)), AllOf(HasSubstr("line 4, column v_mm_s, and x_mm"),
                                               HasSubstr("unit cannot be right"), HasSubstr("mm"), HasSubstr("1000")));
  EXPECT_THAT(message_of(linear(-1.0)), HasSubstr("runs against the position"));
}

TEST_F(BadRecord, UnitsAgainstTheDataSheet) {
  sim::DataSheet sheet;
  sheet.lead = kLead;
  sheet.encoder_resolution = 0.001;
  const auto check = [&](host::Record& record) {
    host::adapt_to(record, sheet);
    host::check_units(record, sheet);
  };
  EXPECT_EQ(message_of(good_text(), check), "no failure");
  EXPECT_THAT(message_of(with_columns([](int, Row& r) { r.w_rad_s *= 60.0 / (2.0 * M_PI); }), check),
              HasSubstr("rev/min"));
  EXPECT_THAT(message_of(with_columns([](int, Row& r) { r.w_rad_s *= 180.0 / M_PI; }), check), HasSubstr("deg/s"));
  EXPECT_THAT(message_of(with_columns([](int, Row& r) { r.x_mm /= 1000.0; }), check), HasSubstr("looks like m under"));
  const auto position_only = [](double factor) {
    return std::string(kHeader) + "t_s,u_V,x_mm\n" +
           rows_of(1000, [=](int, Row r) { return fmt::format("{},{},{}", r.t_s, r.u_V, r.x_mm * factor); });
  };
  EXPECT_EQ(message_of(position_only(1.0), check), "no failure");
  EXPECT_THAT(message_of(position_only(0.001), check), AllOf(HasSubstr("line 4, column x_mm"), HasSubstr("encoder")));
  EXPECT_THAT(message_of(position_only(1000.0), check), AllOf(HasSubstr("column x_mm"), HasSubstr("smaller unit")));
  // Hundreds of counts per row, but not always the same number.
  const std::string steady = std::string(kHeader) + "t_s,u_V,x_mm\n" + rows_of(1000, [](int k, Row r) {
                               return fmt::format("{},{},{:.3f}", r.t_s, r.u_V, 0.7213 * k);
                             });
  EXPECT_EQ(message_of(steady, check), "no failure");
}

TEST_F(BadRecord, DriveOfTheOtherKind) {
  sim::DataSheet sheet;
  sheet.kind = sim::DriveKind::linear;
  EXPECT_THAT(message_of(good_text(), [&](host::Record& r) { host::adapt_to(r, sheet); }),
              AllOf(HasSubstr("line 4, column w_rad_s"), HasSubstr("model is of a linear one"), HasSubstr("v_m_s")));
}

/// The axis with the position of its table, as `table` converts it.
std::string with_table(const std::function<double(double x_mm)>& table, const char* column = "x2_mm") {
  return std::string(kHeader) + "t_s,u_V,x_mm," + column + "\n" +
         rows_of(1000, [&](int, Row r) { return fmt::format("{},{},{},{}", r.t_s, r.u_V, r.x_mm, table(r.x_mm)); });
}

TEST_F(BadRecord, TheTableIsReadInEitherUnit) {
  EXPECT_EQ(message_of(with_table([](double x) { return x + 0.01; })), "no failure");
  EXPECT_EQ(message_of(with_table([](double x) { return 1e-3 * x + 1e-5; }, "x2_m"),
                       [](host::Record& record) { EXPECT_NEAR(record.x2[100], record.x[100] + 0.01, 1e-9); }),
            "no failure");
}

TEST_F(BadRecord, TableThatStandsStill) {
  EXPECT_THAT(message_of(with_table([](double) { return 3.0; })),
              AllOf(HasSubstr("line 4, column x2_mm"), HasSubstr("dead channel"), HasSubstr("x_mm shows motion")));
}

TEST_F(BadRecord, TableThatRunsBackwards) {
  EXPECT_THAT(message_of(with_table([](double x) { return 5.0 - x; })),
              AllOf(HasSubstr("column x2_mm"), HasSubstr("runs against the motor's"), HasSubstr("turn the sign")));
}

TEST_F(BadRecord, TableInAnotherUnit) {
  EXPECT_THAT(
      message_of(with_table([](double x) { return 1000.0 * x + 7.0; })),
      AllOf(HasSubstr("column x2_mm"), HasSubstr("1000 times as far"), HasSubstr("multiply the column by 0.001")));
}

TEST_F(BadRecord, TableThatIsTheMotorsPosition) {
  EXPECT_THAT(message_of(with_table([](double x) { return x; })),
              AllOf(HasSubstr("x2_mm"), HasSubstr("the same numbers")));
}

TEST_F(BadRecord, TableThatIsNoNumber) {
  EXPECT_THAT(message_of(with_table([](double x) { return x > 1.99 ? std::nan("") : x + 0.01; })),
              AllOf(HasSubstr("column 4 (x2_mm)"), HasSubstr("NaN"), HasSubstr("axistool cut")));
}

}  // namespace
