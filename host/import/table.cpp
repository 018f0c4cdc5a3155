#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/exit_codes.hpp"
#include "host/import/log_file.hpp"
#include "host/input_limits.hpp"
#include "host/number.hpp"
#include "host/record/clock.hpp"
#include "host/record/columns.hpp"
#include "host/record/table_layout.hpp"
#include "host/record/text_encoding.hpp"

namespace host {

namespace {

using Fields = std::vector<std::string_view>;

/// "[mm]", "(mm)" -> "mm".
std::string_view without_brackets(std::string_view unit) {
  const bool bracketed =
      unit.size() >= 2 && ((unit.front() == '[' && unit.back() == ']') || (unit.front() == '(' && unit.back() == ')'));
  return bracketed ? trim_blanks(unit.substr(1, unit.size() - 2)) : unit;
}

/// The name of a quantity with this name and unit in records, if there is one; otherwise the name.
std::string name_with_unit(std::string_view name, std::string_view unit) {
  std::string full = fmt::format("{}_{}", name, unit);
  std::ranges::replace(full, '/', '_');
  return find_known_column(full) != nullptr ? full : std::string(name);
}

class TableReader {
 public:
  TableReader(std::string_view text, std::string_view name) : rest_(text), layout_(find_layout(text)) {
    log_.path = name;
  }

  Log read() {
    find_table();
    take_headings();
    log_.first_line = number_;
    std::size_t rows = 0;
    do {
      if (++rows * log_.columns.size() > kMostLogNumbers)
        fail("more than {} numbers, the most that a log may have; cut it, or export fewer columns", kMostLogNumbers);
      if (trim_blanks(line_).empty()) {
        if (rest_.find_first_not_of(" \t\r\n") == std::string_view::npos) break;
        fail("the line is blank; remove it, or cut the log there");
      }
      take_row();
    } while (next_line());
    for (std::size_t k = 0; k < log_.columns.size(); ++k) describe(log_.columns[k], states_[k]);
    return std::move(log_);
  }

 private:
  struct ColumnState {
    bool begun = false, is_clock = false;
    std::optional<std::int64_t> first_day;
  };

  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw Failure(ExitCode::bad_input, fmt::format("{}: line {}: {}", log_.path, std::max<std::size_t>(number_, 1),
                                                   fmt::format(format, std::forward<Args>(args)...)));
  }

  bool next_line() {
    if (!take_line(rest_, line_)) return false;
    ++number_;
    return true;
  }

  bool is_value(std::string_view field) const {
    return layout_.number(field).has_value() || parse_clock(field).has_value();
  }

  /// Sets `line_` to the first line with the number of fields of the table. Earlier lines are remarks or a preamble.
  void find_table() {
    std::size_t preamble = 0;
    while (next_line()) {
      if (trim_blanks(line_).empty()) continue;
      if (is_remark(line_)) {
        take_remark();
        continue;
      }
      layout_.split(line_, fields_);
      if (fields_.size() == layout_.fields + 1 && fields_.back().empty())
        fields_.pop_back();  // headings that end with a separator
      if (fields_.size() == layout_.fields) break;
      if (fields_.size() > 1 && std::ranges::all_of(fields_, [&](std::string_view f) { return is_value(f); }))
        fail_field_count(layout_.fields);
      keep_preamble();
      ++preamble;
    }
    if (trim_blanks(line_).empty()) fail("no rows; name a file that contains a log");
    if (preamble > 0)
      log_.header["imported_preamble"] = fmt::format("{} lines before the table were left out", preamble);
  }

  void keep_preamble() {
    if (log_.preamble.size() < kMostPreamble) log_.preamble.emplace_back(line_.substr(0, kLongestPreamble));
  }

  void take_remark() {
    keep_preamble();
    const std::string_view text = trim_blanks(line_);
    const std::size_t colon = text.find(':');
    if (colon != std::string_view::npos)
      log_.header.emplace(trim_blanks(text.substr(1, colon - 1)), trim_blanks(text.substr(colon + 1)));
  }

  void take_headings() {
    log_.columns.resize(fields_.size());
    states_.resize(fields_.size());
    for (LogColumn& column : log_.columns) column.last_digit = std::numeric_limits<double>::infinity();
    if (std::ranges::all_of(fields_, [&](std::string_view f) { return f.empty() || is_value(f); })) return;
    for (std::size_t k = 0; k < fields_.size(); ++k) log_.columns[k].name = fields_[k];
    constexpr int kMostHeadings = 4;
    for (int k = 0; k < kMostHeadings; ++k) {
      if (!next_line()) fail("no rows follow the headings; name a file that contains a log");
      while (is_remark(line_) && next_line()) {
      }
      layout_.split(line_, fields_);
      if (!are_headings(fields_)) return;
      if (log_.header.contains("imported_units") || !take_units()) append_headings();
    }
  }

  /// Whether this is a further line of headings: the same number of texts, and no values.
  bool are_headings(const Fields& fields) const {
    return fields.size() == log_.columns.size() &&
           std::ranges::any_of(fields, [](std::string_view f) { return !f.empty(); }) &&
           std::ranges::none_of(fields, [&](std::string_view f) { return is_value(f); });
  }

  /// Takes the line as units if all of its texts are as short as units.
  bool take_units() {
    constexpr std::size_t kLongestUnit = 16;
    if (std::ranges::any_of(fields_, [](std::string_view f) { return f.size() > kLongestUnit; })) return false;
    for (std::size_t k = 0; k < fields_.size(); ++k) {
      log_.columns[k].unit = without_brackets(fields_[k]);
      log_.columns[k].name = name_with_unit(log_.columns[k].name, log_.columns[k].unit);
    }
    log_.header["imported_units"] = fmt::format("{}", fmt::join(fields_, ", "));
    return true;
  }

  /// Appends the second line of headings to the first: "Analog 1" above "Servo motor speed".
  void append_headings() {
    for (std::size_t k = 0; k < fields_.size(); ++k)
      if (!fields_[k].empty())
        log_.columns[k].name += fmt::format("{}{}", log_.columns[k].name.empty() ? "" : " ", fields_[k]);
  }

  [[noreturn]] void fail_field_count(std::size_t columns) const {
    fail("{} fields where there are {} columns; correct the line ({}fields here are separated by {})", fields_.size(),
         columns, layout_.decimal_comma ? "" : "numbers take a decimal point, and ", layout_.separator_name());
  }

  void take_row() {
    layout_.split(line_, fields_);
    if (fields_.size() != log_.columns.size()) fail_field_count(log_.columns.size());
    for (std::size_t k = 0; k < fields_.size(); ++k) take_field(k, fields_[k]);
  }

  void take_field(std::size_t k, std::string_view field) {
    LogColumn& column = log_.columns[k];
    if (field.empty()) {
      column.values.push_back(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    const std::optional<double> value = value_of(states_[k], column, field);
    if (!value && column.fault.empty())
      column.fault = fmt::format(
          "line {}, column {}{}: '{}' is not a {}{}; correct it, or cut the log before this line", number_, k + 1,
          column.name.empty() ? "" : fmt::format(" ({})", column.name), field,
          states_[k].is_clock ? "date or time of day" : "number",
          !layout_.decimal_comma && field.find(',') != std::string_view::npos ? " (numbers take a decimal point)" : "");
    column.values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
  }

  /// If the first value of a column is a time of day, the column counts seconds from midnight of the first day.
  std::optional<double> value_of(ColumnState& state, LogColumn& column, std::string_view field) const {
    const bool is_first = !std::exchange(state.begun, true);
    const std::optional<double> number = layout_.number(field);
    if (is_first && !number) state.is_clock = parse_clock(field).has_value();
    if (!state.is_clock) {
      if (number) column.last_digit = std::min(column.last_digit, layout_.last_digit(field));
      return number;
    }
    const std::optional<ClockReading> reading = parse_clock(field);
    if (!reading) return std::nullopt;
    if (!state.first_day) state.first_day = reading->day;
    column.last_digit = std::min(column.last_digit, reading->last_digit);
    constexpr double kDay_s = 86'400.0;
    return kDay_s * static_cast<double>(reading->day.value_or(0) - state.first_day.value_or(0)) + reading->second;
  }

  static void describe(LogColumn& column, const ColumnState& state) {
    column.kind = fmt::format("{} {}{}", column.values.size(),
                              state.is_clock ? "times, s from the first day's midnight" : "numbers",
                              column.unit.empty() ? "" : fmt::format(", {}", column.unit));
  }

  std::string_view rest_, line_;
  TableLayout layout_;
  std::size_t number_ = 0;
  Fields fields_;
  std::vector<ColumnState> states_;
  Log log_;
};

}  // namespace

Log parse_table(std::string_view text, std::string_view name) {
  const std::string plain = as_utf8(std::string(text));
  return TableReader(plain, name).read();
}

}  // namespace host
