// Tables as loggers, spreadsheets and NumPy write them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "host/exit_codes.hpp"
#include "host/import/import_record.hpp"
#include "host/record/clock.hpp"
#include "host/record/read_record.hpp"
#include "host/record/text_encoding.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr int kRows = 60;

double command(int k) { return std::sin(0.1 * k); }
double position(int k) { return 1.5 * k * k * 1e-3; }

host::Record import(std::string_view text, std::string_view map) {
  host::ImportOptions options;
  if (!map.empty()) options.mappings = host::parse_mappings(map);
  return host::import_record(host::parse_table(text, "log.txt"), options);
}

void expect_the_log(const host::Record& record) {
  ASSERT_EQ(record.size(), static_cast<std::size_t>(kRows));
  for (int k = 0; k < kRows; ++k) {
    EXPECT_NEAR(record.t_s[k] - record.t_s[0], 0.01 * k, 1e-9);
    EXPECT_NEAR(record.u_V[k], command(k), 1e-6);
    EXPECT_NEAR(record.x[k], position(k), 1e-6);
  }
}

/// Rows of t, u, x. `{}` in `stamp` stands for the time in seconds.
std::string rows(const char* separator, bool decimal_comma) {
  std::string text;
  for (int k = 0; k < kRows; ++k) {
    std::string line = fmt::format("{:.2f}{}{:.7f}{}{:.7f}\n", 0.01 * k, separator, command(k), separator, position(k));
    if (decimal_comma)
      for (char& c : line) c = c == '.' ? ',' : c;
    text += line;
  }
  return text;
}

std::string utf16(std::string_view text, bool big_end_first, bool marked) {
  std::string bytes = !marked ? "" : big_end_first ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) bytes += big_end_first ? std::string{'\0', c} : std::string{c, '\0'};
  return bytes;
}

TEST(LoggerFormats, DecimalCommasWithSemicolonsTabsOrBlanks) {
  for (const char* separator : {";", "\t", "  "})
    expect_the_log(import(std::string("t_s") + separator + "u_V" + separator + "x_mm\n" + rows(separator, true), ""));
}

TEST(LoggerFormats, ADecimalCommaMakesNoColumn) {
  const host::Log log = host::parse_table("a;b\n1,5;2,5\n2,5;3,5\n", "log.txt");
  ASSERT_EQ(log.columns.size(), 2u);
  EXPECT_EQ(log.columns[1].values, (std::vector<double>{2.5, 3.5}));
}

TEST(LoggerFormats, ThousandsAreNoNumbers) {
  const host::Log log = host::parse_table("a;b\n1,5;2\n1.002,5;3\n2,5;4\n", "log.txt");
  EXPECT_THAT(log.columns[0].fault, AllOf(HasSubstr("line 3"), HasSubstr("'1.002,5' is not a number")));
}

TEST(LoggerFormats, APreambleIsLeftOutAndStated) {
  const std::string preamble = "Drive logger 3.1\nMachine;M 7\nStarted 4 March, about noon\n\nChannels: 3\n";
  const host::Record record = import(preamble + "t;cmd;pos\n" + rows(";", false), "t_s=t,u_V=cmd,x_mm=pos");
  expect_the_log(record);
  EXPECT_THAT(record.header.at("imported_preamble"), HasSubstr("4 lines"));
}

/// A first row that lacks a field must not be taken for a preamble.
TEST(LoggerFormats, RowsOfNumbersAreNoPreamble) {
  EXPECT_THROW(import("0.0,1.0\n" + rows(",", false), "t_s=1,u_V=2,x_mm=3"), host::Failure);
}

TEST(LoggerFormats, NamesAndUnitsOnTwoLines) {
  const host::Record known = import("t;u;x\n[s];[V];[mm]\n" + rows(";", true), "");
  expect_the_log(known);
  EXPECT_THAT(known.header.at("imported_units"), HasSubstr("[mm]"));
  const host::Log other = host::parse_table("time;cmd;pos\ns;V;counts\n" + rows(";", true), "log.txt");
  EXPECT_EQ(other.columns[2].name, "pos");
  EXPECT_THAT(other.columns[2].kind, HasSubstr("counts"));
  expect_the_log(import("time;cmd;pos\ns;V;counts\n" + rows(";", true), "t_s=time,u_V=cmd,x_mm=pos"));
}

TEST(LoggerFormats, ASecondRowWithANumberIsNoUnits) {
  const host::Log log = host::parse_table("a,b\nx,1\n2,2\n3,3\n", "log.txt");
  EXPECT_THAT(log.columns[0].fault, HasSubstr("line 2, column 1 (a): 'x' is not a number"));
}

TEST(LoggerFormats, DatesAndTimesBecomeSecondsAlsoOverMidnight) {
  std::string text = "Time,u,x\n";
  for (int k = 0; k < kRows; ++k) {
    const double second = 59.7 + 0.01 * k;
    text += second < 60.0 - 1e-9 ? fmt::format("2026-02-28 23:59:{:05.2f}", second)
                                 : fmt::format("2026-03-01 00:00:{:05.2f}", second - 60.0);
    text += fmt::format(",{:.7f},{:.7f}\n", command(k), position(k));
  }
  const host::Record record = import(text, "t_s=Time,u_V=u,x_mm=x");
  expect_the_log(record);
  EXPECT_NEAR(record.t_s[0], 86'399.7, 1e-9);
}

TEST(LoggerFormats, ClocksInTheirForms) {
  EXPECT_EQ(host::parse_clock("1970-01-02")->day, 1);
  EXPECT_EQ(host::parse_clock("2000-03-01")->day, 11'017);
  EXPECT_EQ(host::parse_clock("01.03.2000")->day, 11'017);
  EXPECT_EQ(host::parse_clock("2000/03/01T01:02:03.25Z")->second, 3723.25);
  EXPECT_EQ(host::parse_clock("01:02:03,250")->last_digit, 0.001);
  EXPECT_FALSE(host::parse_clock("01:02:03")->day.has_value());
  for (const char* text :
       {"", "12", "3.5", "03/04/2026", "25:00:00", "12:60:00", "12:34", "2026-13-01", "x", "12:34:5"})
    EXPECT_FALSE(host::parse_clock(text)) << text;
}

TEST(LoggerFormats, Utf16OfBothKindsWithAndWithoutMark) {
  const std::string text = "t_s,u_V,x_mm\n" + rows(",", false);
  for (const bool big : {false, true})
    for (const bool marked : {false, true}) expect_the_log(import(utf16(text, big, marked), ""));
  EXPECT_EQ(host::as_utf8(std::string("\xFF\xFE\xB0\0\x3D\xD8\0\xDE", 8)), "\xC2\xB0\xF0\x9F\x98\x80");
  EXPECT_EQ(host::as_utf8("\xEF\xBB\xBF\xB0"), "\xC2\xB0");  // a UTF-8 mark before a byte of Windows-1252
  const std::string record = "# format: axis-record/1\n" + text;
  expect_the_log(host::parse_record(utf16(record, false, true), "r.csv"));
}

/// A .npy file according to NEP 1.
std::string npy(const std::string& description, const std::string& data) {
  std::string header = description;
  while ((10 + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string file = "\x93NUMPY\x01";
  file += '\0';
  file += static_cast<char>(header.size() & 0xFF);
  file += static_cast<char>(header.size() >> 8);
  return file + header + data;
}

template <typename Number>
void put(std::string& bytes, Number value, bool big_end_first = false) {
  std::string one(sizeof value, '\0');
  std::memcpy(one.data(), &value, sizeof value);
  if (big_end_first) std::ranges::reverse(one);
  bytes += one;
}

host::Record import_npy(const std::string& file, std::string_view map) {
  const TemporaryFolder folder;
  host::ImportOptions options;
  options.mappings = host::parse_mappings(map);
  return host::import_record(host::read_log(folder.write("log.npy", file)), options);
}

TEST(LoggerFormats, NumpyArraysByRowsAndByColumns) {
  std::string by_rows, by_columns;
  for (int k = 0; k < kRows; ++k) put(by_rows, 0.01 * k), put(by_rows, command(k)), put(by_rows, position(k));
  for (int k = 0; k < kRows; ++k) put(by_columns, 0.01 * k, true);
  for (int k = 0; k < kRows; ++k) put(by_columns, command(k), true);
  for (int k = 0; k < kRows; ++k) put(by_columns, position(k), true);
  expect_the_log(
      import_npy(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (60, 3), }", by_rows), "t_s=1,u_V=2,x_mm=3"));
  expect_the_log(
      import_npy(npy("{'descr': '>f8', 'fortran_order': True, 'shape': (60, 3), }", by_columns), "t_s=1,u_V=2,x_mm=3"));
}

TEST(LoggerFormats, NumpyRowsWithNamedFields) {
  std::string data;
  for (int k = 0; k < kRows; ++k)
    put(data, static_cast<std::int32_t>(k)), put(data, static_cast<float>(command(k))), put(data, position(k));
  expect_the_log(import_npy(
      npy("{'descr': [('n', '<i4'), ('cmd', '<f4'), ('pos', '<f8')], 'fortran_order': False, 'shape': (60,), }", data),
      "t_s=n*0.01,u_V=cmd,x_mm=pos"));
}

TEST(LoggerFormats, DamagedAndForeignArraysAreRefused) {
  const std::string good = "{'descr': '<f8', 'fortran_order': False, 'shape': (60, 3), }";
  for (const std::string& file :
       {npy(good, "short"), npy("{'descr': '<c16', 'fortran_order': False, 'shape': (2,), }", std::string(64, ' ')),
        npy("{'descr': '|O', 'fortran_order': False, 'shape': (2,), }", std::string(64, ' ')), npy("{}", ""),
        npy("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999, 9999999999), }", "xx"),
        std::string("\x93NUMPY\x01\0\xff", 9), std::string("PK\x03\x04zip")})
    EXPECT_THROW(import_npy(file, "t_s=1,u_V=2,x_mm=3"), host::Failure);
}

}  // namespace
