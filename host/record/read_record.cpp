#include "host/record/read_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/exit_codes.hpp"
#include "host/number.hpp"
#include "host/read_file.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/columns.hpp"
#include "host/record/log_fault.hpp"
#include "host/record/text_encoding.hpp"
#include "host/record/time_axis.hpp"

namespace host {

namespace {

constexpr std::string_view kRecordFormat = "axis-record/1";

/// Returns the lines of a text one by one, without line ends. Counts them for messages.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number_;
    return true;
  }
  std::size_t number() const { return number_; }
  bool only_blanks_left() const { return rest_.find_first_not_of(" \t\r\n") == std::string_view::npos; }
  std::size_t bytes_left() const { return rest_.size(); }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

struct Column {
  std::string_view name;
  const KnownColumn* known = nullptr;
  std::vector<double> values;
  std::vector<std::string_view> fields;  ///< fields of columns that the format does not contain
};

class Parser {
 public:
  Parser(std::string_view text, std::string_view name) : lines_(text), name_(name) { record_.path = name; }

  Record parse() {
    read_header();
    read_column_names();
    read_rows();
    fill();
    const TimeAxis axis{record_.t_s, stamp_resolution_s_, record_.names_line + 1};
    record_.sample_period_s = check_time_axis(axis, header_period_s_, period_line_, record_.path);
    if (record_.size() < kFewestRows)
      fail_here("the record ends after {} rows, too short: at least {} are needed; record for longer", record_.size(),
                kFewestRows);
    check_channels(record_);
    return std::move(record_);
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw Failure(ExitCode::bad_input, fmt::format("{}: {}", name_, fmt::format(format, std::forward<Args>(args)...)));
  }
  template <typename... Args>
  [[noreturn]] void fail_here(fmt::format_string<Args...> format, Args&&... args) const {
    fail("line {}: {}", lines_.number(), fmt::format(format, std::forward<Args>(args)...));
  }

  /// Reads the `#` lines. Afterwards `line_` is the line with the column names.
  void read_header() {
    if (lines_.only_blanks_left()) fail("the file is empty; record again, or name another file");
    while (lines_.next(line_) && line_.starts_with('#')) read_header_line();
    if (line_.starts_with('#') || trim_blanks(line_).empty())
      fail(
          "line {}: the line with the column names is missing; put one (t_s,u_V,x_mm,…) after the lines that begin "
          "with #",
          lines_.number());
    if (!record_.header.contains("format"))
      fail(
          "line 1: there is no '# format: {}' line, so the meaning of the columns is unknown; add it if the file has "
          "that format, else convert it: axistool import {} --map t_s=…,u_V=…,x_mm=… -o record.csv",
          kRecordFormat, name_);
  }

  void read_header_line() {
    const std::size_t colon = line_.find(':');
    if (colon == std::string_view::npos) return;  // a comment
    const std::string key(trim_blanks(line_.substr(1, colon - 1)));
    const std::string value(trim_blanks(line_.substr(colon + 1)));
    if (!record_.header.emplace(key, value).second)
      fail_here("'# {}:' occurs twice in the header; keep one of them", key);
    if (key == "format" && value != kRecordFormat)
      fail_here("format '{}' is unknown; this program reads {}", value, kRecordFormat);
    if (key == "drive") record_.drive = value;
    if (key == "sample_period_s") {
      const auto period = parse_number(value);
      if (!period || !std::isfinite(*period) || *period <= 0.0)
        fail_here("sample_period_s: '{}' is not a positive number of seconds; correct it or leave the line out", value);
      header_period_s_ = *period;
      period_line_ = lines_.number();
    }
  }

  void read_column_names() {
    record_.names_line = lines_.number();
    for (std::string_view rest = line_;;) {
      const std::size_t comma = rest.find(',');
      const std::string_view name = trim_blanks(rest.substr(0, comma));
      if (name.empty()) fail_here("column {} has no name; name it, or remove the comma", columns_.size() + 1);
      if (parse_number(name))
        fail_here("found '{}' instead of column names; put a line such as t_s,u_V,x_mm before the rows", name);
      columns_.push_back({name, find_known_column(name), {}, {}});
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
    std::vector<std::string_view> names;
    for (const Column& column : columns_) names.push_back(column.name);
    if (const std::string fault = fault_of_columns(names); !fault.empty()) fail_here("{}", fault);
  }

  void read_rows() {
    if (lines_.only_blanks_left())
      fail("line {}: no rows follow the column names; the record is empty, record again", lines_.number());
    const std::size_t expected_rows = lines_.bytes_left() / (2 * columns_.size()) + 1;
    constexpr std::size_t kReserveAtMost = 1U << 20U;  // more rows grow the vectors as usual
    for (Column& column : columns_) {
      if (column.known)
        column.values.reserve(std::min(expected_rows, kReserveAtMost));
      else
        column.fields.reserve(std::min(expected_rows, kReserveAtMost));
    }
    for (std::size_t rows = 1; !lines_.only_blanks_left() && lines_.next(line_); ++rows) {
      if (rows * columns_.size() > kMostLogNumbers)
        fail_here("more than {} numbers, the most that a record may have; cut it, or record fewer columns",
                  kMostLogNumbers);
      read_row();
    }
  }

  void read_row() {
    if (line_.starts_with('#')) fail_here("a line that begins with # is among the rows; move it to the top");
    if (trim_blanks(line_).empty()) fail_here("the line is blank; remove it, or cut the record there (axistool cut)");
    std::string_view rest = line_;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const std::size_t comma = rest.find(',');
      if ((comma == std::string_view::npos) != (k + 1 == columns_.size())) fail_field_count();
      take_field(columns_[k], rest.substr(0, comma));
      if (comma != std::string_view::npos) rest.remove_prefix(comma + 1);
    }
  }

  [[noreturn]] void fail_field_count() const {
    const std::size_t count = static_cast<std::size_t>(std::ranges::count(line_, ',')) + 1;
    fail_here("wrong number of fields: {} where line {} names {} columns; {}", count, record_.names_line,
              columns_.size(),
              lines_.only_blanks_left() && count < columns_.size()
                  ? "the last line seems cut off: remove it"
                  : "correct the line (numbers take a decimal point, fields are separated by one comma)");
  }

  void take_field(Column& column, std::string_view field) {
    if (!column.known) {
      column.fields.push_back(field);
      return;
    }
    const auto value = parse_number(field);
    if (!value || !std::isfinite(*value)) fail_value(column, trim_blanks(field));
    column.values.push_back(*value);
    if (column.known->channel == &Record::t_s)
      stamp_resolution_s_ = std::min(stamp_resolution_s_, last_digit_of(field));
  }

  [[noreturn]] void fail_value(const Column& column, std::string_view field) const {
    const std::size_t number = static_cast<std::size_t>(&column - columns_.data()) + 1;
    const auto value = parse_number(field);
    const std::string what = field.empty()                 ? "the field is empty"
                             : value && std::isnan(*value) ? fmt::format("'{}' (NaN) is not a measured value", field)
                             : value ? fmt::format("'{}' (infinite) is not a measured value", field)
                                     : fmt::format("'{}' is not a number", field);
    fail_here("column {} ({}): {}; correct it, or cut the record before this line (axistool cut)", number, column.name,
              what);
  }

  void fill() {
    std::vector<NamedColumn> known;
    for (Column& column : columns_) {
      if (column.known)
        known.push_back({column.name, std::move(column.values)});
      else
        record_.extra.push_back(as_extra(column));
    }
    if (const std::string fault = fault_of_copies(known); !fault.empty()) {
      const std::string message = fmt::format("{}: line {}: {}", name_, record_.names_line, fault);
      throw FaultyLog(message, {{LogFaultKind::copied_channel, {}, std::string(name_), 0.0, 0.0, message}});
    }
    fill_channels(std::move(known), record_);
  }

  static ExtraChannel as_extra(const Column& column) {
    ExtraChannel extra{std::string(column.name), {}, {}};
    bool all_numbers = true;
    for (const std::string_view field : column.fields) {
      const auto value = parse_number(field);
      extra.values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
      all_numbers = all_numbers && value && std::isfinite(*value);
    }
    if (!all_numbers)
      for (const std::string_view field : column.fields) extra.text.emplace_back(trim_blanks(field));
    return extra;
  }

  Lines lines_;
  std::string_view name_;
  std::string_view line_;
  Record record_;
  std::vector<Column> columns_;
  std::optional<double> header_period_s_;
  std::size_t period_line_ = 0;
  double stamp_resolution_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace

Record parse_record(std::string_view text, std::string_view name) {
  const std::string plain = as_utf8(std::string(text));
  return Parser(plain, name).parse();
}

Record read_record(const std::string& path) {
  const std::string plain = as_utf8(read_file(path, kRecordSize));
  return Parser(plain, path).parse();
}

}  // namespace host
