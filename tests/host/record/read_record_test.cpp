// Reading of records: units, kinds of drive, additional columns, and writing without loss.
#include "host/record/read_record.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "host/exit_codes.hpp"
#include "host/record/channel_checks.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

std::string record_text(std::string_view names, std::string_view rest_of_row, double period_s = 0.001) {
  std::string text = fmt::format("# format: axis-record/1\n# drive: table\n# operator: A. Smith\n{}\n", names);
  for (int k = 0; k < 40; ++k) text += fmt::format("{:.6f},{},{}\n", k * period_s, 0.1 * k, rest_of_row);
  return text;
}

TEST(ReadRecord, RotaryChannelsInMillimetresAndRadiansPerSecond) {
  const host::Record record = host::parse_record(record_text("t_s,u_V,x_mm,w_rad_s", "12.5,0.25"), "r.csv");
  EXPECT_EQ(record.kind, sim::DriveKind::rotary);
  EXPECT_FALSE(record.kind_is_presumed);
  EXPECT_EQ(record.drive, "table");
  EXPECT_EQ(record.header.at("operator"), "A. Smith");
  EXPECT_EQ(record.size(), 40u);
  EXPECT_DOUBLE_EQ(record.sample_period_s, 0.001);
  EXPECT_EQ(record.x[7], 12.5);
  EXPECT_EQ(record.w[7], 0.25);
  EXPECT_DOUBLE_EQ(record.u_V[7], 0.7);
}

TEST(ReadRecord, OrderOfColumnsUnknownOnesAndTrailingDecimalsChangeNothing) {
  std::string plain = "# format: axis-record/1\nt_s,u_V,x_mm,w_rad_s\n";
  std::string written = "# format: axis-record/1\nw_rad_s,room_humidity,x_mm,t_s,u_V\n";
  for (int k = 0; k < 40; ++k) {
    const double t_s = 0.001 * k, u_V = 0.1 * k, x_mm = 0.5 * k * k, w_rad_s = 1.25 * k;
    plain += fmt::format("{:.3f},{:.2f},{:.2f},{:.2f}\n", t_s, u_V, x_mm, w_rad_s);
    written += fmt::format("{:.9f},{},{:.8f},{:.6f},{:.7f}\n", w_rad_s, 40 + k % 3, x_mm, t_s, u_V);
  }
  const host::Record one = host::parse_record(plain, "a.csv"), other = host::parse_record(written, "b.csv");
  EXPECT_EQ(one.t_s, other.t_s);
  EXPECT_EQ(one.u_V, other.u_V);
  EXPECT_EQ(one.x, other.x);
  EXPECT_EQ(one.w, other.w);
  EXPECT_EQ(one.sample_period_s, other.sample_period_s);
}

TEST(ReadRecord, MetresOnARotaryDriveBecomeMillimetres) {
  const host::Record record = host::parse_record(record_text("t_s,u_V,x_m,w_rad_s", "0.0125,0.25"), "r.csv");
  EXPECT_DOUBLE_EQ(record.x[0], 12.5);
}

TEST(ReadRecord, LinearDriveIsHeldInMetres) {
  const host::Record record = host::parse_record(record_text("t_s,u_V,x_mm,v_mm_s", "12.5,250"), "r.csv");
  EXPECT_EQ(record.kind, sim::DriveKind::linear);
  EXPECT_DOUBLE_EQ(record.x[0], 0.0125);
  EXPECT_DOUBLE_EQ(record.w[0], 0.25);
}

TEST(ReadRecord, PositionAloneFitsEitherKindOfDrive) {
  sim::DataSheet rotary, linear;
  linear.kind = sim::DriveKind::linear;
  for (const auto& [names, value] : {std::pair{"t_s,u_V,x_mm", "12.5"}, {"t_s,u_V,x_m", "0.0125"}}) {
    host::Record record = host::parse_record(record_text(names, value), "r.csv");
    EXPECT_TRUE(record.kind_is_presumed);
    host::Record other = record;
    host::adapt_to(record, rotary);
    EXPECT_DOUBLE_EQ(record.x[0], 12.5);
    host::adapt_to(other, linear);
    EXPECT_DOUBLE_EQ(other.x[0], 0.0125);
    EXPECT_EQ(other.kind, sim::DriveKind::linear);
  }
}

TEST(ReadRecord, CurrentAloneIsEnoughForARotaryDrive) {
  host::Record record = host::parse_record(record_text("t_s,i_A,w_rad_s", "0.5"), "r.csv");
  EXPECT_TRUE(record.u_V.empty());
  EXPECT_DOUBLE_EQ(record.i_A[10], 1.0);
  EXPECT_NO_THROW(host::adapt_to(record, sim::DataSheet{}));
}

TEST(ReadRecord, UnknownColumnsAreKept) {
  const host::Record record = host::parse_record(record_text("t_s,u_V,x_mm,pressure_bar,mode", "1.5,6.2,jog"), "r.csv");
  ASSERT_EQ(record.extra.size(), 2u);
  EXPECT_EQ(record.extra[0].name, "pressure_bar");
  EXPECT_DOUBLE_EQ(record.extra[0].values[3], 6.2);
  EXPECT_TRUE(record.extra[0].text.empty());
  EXPECT_EQ(record.extra[1].text[3], "jog");
}

TEST(ReadRecord, AcceptsWindowsLineEndsByteOrderMarkAndBlanks) {
  std::string text = "\xEF\xBB\xBF# format: axis-record/1\r\nt_s , u_V, x_mm\r\n";
  for (int k = 0; k < 30; ++k) text += fmt::format(" {}, +{} ,0\r\n", k * 0.5, k);
  const host::Record record = host::parse_record(text + "\r\n", "r.csv");
  EXPECT_EQ(record.size(), 30u);
  EXPECT_EQ(record.u_V[29], 29.0);
}

TEST(ReadRecord, TextIsKeptWithoutTheBlanksRoundIt) {
  const host::Record record = host::parse_record(record_text("t_s,u_V,x_mm,mode", "1, jog \r\r"), "r.csv");
  EXPECT_EQ(record.extra[0].text[3], "jog");
}

TEST(ReadRecord, PeriodsOfPicosecondsAreNotRoundedAway) {
  std::string text = "# format: axis-record/1\nt_s,u_V,x_mm\n";
  for (int k = 0; k < 30; ++k) text += fmt::format("{},{},0\n", k * 1.25e-12, k);
  EXPECT_DOUBLE_EQ(host::parse_record(text, "r.csv").sample_period_s, 1.25e-12);
}

TEST(ReadRecord, StampsRoundedToTheirLastDigitAreEvenlySpaced) {
  // 30 kHz with stamps in microseconds: the steps are 33 and 34 us.
  EXPECT_NEAR(host::parse_record(record_text("t_s,u_V,x_mm", "1", 1.0 / 30000.0), "r.csv").sample_period_s,
              1.0 / 30000.0, 1e-8);
}

TEST(WriteRecord, RoundTripsToTheLastBit) {
  const TemporaryFolder folder;
  host::Record record;
  record.drive = "y";
  record.header = {{"format", "axis-record/1"}, {"note", "a: b"}};
  record.sample_period_s = 0.00025;
  for (int k = 0; k < 500; ++k) {
    record.t_s.push_back(k * 0.00025);
    record.u_V.push_back(std::sin(k * 1.7) * 1e-3);
    record.i_A.push_back(std::exp(std::sin(k * 0.9) * 5.0));
    record.x.push_back(std::round(std::sin(k * 0.01) * 5e4) * 0.00244140625);
    record.x2.push_back(record.x.back() + 0.003 * std::sin(k * 0.02));
    record.w.push_back(std::cos(k * 0.01) / 3.0 + 0.2 * std::sin(k * 2.1));
    record.x_ref.push_back(std::sin(k * 0.01) * 122.0);
    record.w_ref.push_back(1.0 / (k + 3.0));
    record.temp_C.push_back(20.0 + 0.1 * k);
  }
  record.extra = {{"load_N", std::vector<double>(500, 1.0 / 7.0), {}},
                  {"mode", {}, std::vector<std::string>(500, "a b")}};
  for (const sim::DriveKind kind : {sim::DriveKind::rotary, sim::DriveKind::linear}) {
    record.kind = kind;
    if (kind == sim::DriveKind::linear)
      record.x.clear(), record.x2.clear();  // its speed does not match the position above
    const std::string path = folder.path("record.csv");
    host::write_record(record, path);
    const host::Record again = host::read_record(path);
    EXPECT_EQ(again.kind, kind);
    EXPECT_EQ(again.drive, "y");
    EXPECT_EQ(again.header.at("note"), "a: b");
    EXPECT_EQ(again.sample_period_s, record.sample_period_s);
    EXPECT_EQ(again.t_s, record.t_s);
    EXPECT_EQ(again.u_V, record.u_V);
    EXPECT_EQ(again.i_A, record.i_A);
    EXPECT_EQ(again.x, record.x);
    EXPECT_EQ(again.x2, record.x2);
    EXPECT_EQ(again.w, record.w);
    EXPECT_EQ(again.x_ref, record.x_ref);
    EXPECT_EQ(again.w_ref, record.w_ref);
    EXPECT_EQ(again.temp_C, record.temp_C);
    ASSERT_EQ(again.extra.size(), 2u);
    EXPECT_EQ(again.extra[0].values, record.extra[0].values);
    EXPECT_EQ(again.extra[1].text, record.extra[1].text);
    EXPECT_EQ(host::format_record(again), host::format_record(record));
  }
}

TEST(WriteRecord, SaysWhyItCannot) {
  try {
    host::write_record(host::parse_record(record_text("t_s,u_V,x_mm", "1"), "r.csv"), "/nowhere/at/all.csv");
    FAIL();
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    EXPECT_NE(std::strstr(failure.what(), "/nowhere/at/all.csv"), nullptr);
  }
}

TEST(ReadRecord, MeasuredDriveCasesPassAllChecks) {
  const std::filesystem::path cases = std::filesystem::path(AXIS_SHARED_DIR) / "data" / "drive-cases";
  if (!std::filesystem::exists(cases)) GTEST_SKIP() << "no records in " << cases;
  // The lead and the encoder of the paper's drives, 10 mm/rev and 2^-9 * 1.25 mm, which all cases have.
  sim::DataSheet sheet;
  sheet.lead = 1.5915494309189535;
  sheet.encoder_resolution = 0.00244140625;
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(cases)) {
    if (entry.path().extension() != ".csv") continue;
    host::Record record;
    ASSERT_NO_THROW(record = host::read_record(entry.path().string())) << entry.path();
    EXPECT_EQ(record.sample_period_s, 0.001);
    host::adapt_to(record, sheet);
    EXPECT_NO_THROW(host::check_units(record, sheet));
    ++count;
  }
  EXPECT_GT(count, 0);
}

}  // namespace
