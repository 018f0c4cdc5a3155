#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/exit_codes.hpp"
#include "host/record/import_log.hpp"
#include "host/record/number.hpp"

namespace host {

namespace {

using Fields = std::vector<std::string_view>;

std::string_view unquoted(std::string_view field) {
  field = trim_blanks(field);
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
  return field;
}

/// `separator` 0 stands for any run of blanks. A separator inside double quotes does not separate.
void split(std::string_view line, char separator, Fields& fields) {
  fields.clear();
  if (separator == 0) {
    for (line = trim_blanks(line); !line.empty(); line = trim_blanks(line)) {
      const std::size_t end = line.front() == '"' ? line.find('"', 1) : line.find_first_of(" \t");
      const std::size_t length = end == std::string_view::npos ? line.size() : end + (line.front() == '"' ? 1 : 0);
      fields.push_back(unquoted(line.substr(0, length)));
      line.remove_prefix(length);
    }
    return;
  }
  bool in_quotes = false;
  std::size_t start = 0;
  for (std::size_t k = 0; k <= line.size(); ++k) {
    if (k < line.size() && line[k] == '"') in_quotes = !in_quotes;
    if (k < line.size() && (in_quotes || line[k] != separator)) continue;
    fields.push_back(unquoted(line.substr(start, k - start)));
    start = k + 1;
  }
}

class TableReader {
 public:
  TableReader(std::string_view text, std::string_view name) : rest_(text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
    log_.path = name;
  }

  Log read() {
    skip_remarks();
    if (line_.empty()) fail("no rows; name a file that holds a log");
    find_separator();
    Fields fields;
    split(line_, separator_, fields);
    const bool headed = std::ranges::any_of(fields, [](std::string_view f) { return !f.empty() && !parse_number(f); });
    log_.columns.resize(fields.size());
    for (std::size_t k = 0; headed && k < fields.size(); ++k) log_.columns[k].name = fields[k];
    for (LogColumn& column : log_.columns) column.last_digit = std::numeric_limits<double>::infinity();
    if (headed && !next_line()) fail("no rows follow the headings; name a file that holds a log");
    log_.first_line = number_;
    do {
      if (trim_blanks(line_).empty()) {
        if (rest_.find_first_not_of(" \t\r\n") == std::string_view::npos) break;
        fail("the line is blank; remove it, or cut the log there");
      }
      take_row(fields);
    } while (next_line());
    for (LogColumn& column : log_.columns) column.kind = fmt::format("{} numbers", column.values.size());
    return std::move(log_);
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw Failure(ExitCode::bad_input, fmt::format("{}: line {}: {}", log_.path, std::max<std::size_t>(number_, 1),
                                                   fmt::format(format, std::forward<Args>(args)...)));
  }

  bool next_line() {
    if (rest_.empty()) {
      line_ = {};
      return false;
    }
    const std::size_t end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    ++number_;
    return true;
  }

  void skip_remarks() {
    while (next_line()) {
      const std::string_view text = trim_blanks(line_);
      if (text.empty()) continue;
      if (!text.starts_with('#') && !text.starts_with('%')) return;
      const std::size_t colon = text.find(':');
      if (colon == std::string_view::npos) continue;
      log_.header.emplace(trim_blanks(text.substr(1, colon - 1)), trim_blanks(text.substr(colon + 1)));
    }
    line_ = {};
  }

  /// The first of these that splits the line; blanks otherwise.
  void find_separator() {
    Fields fields;
    for (const char candidate : {'\t', ';', ','}) {
      split(line_, candidate, fields);
      if (fields.size() < 2) continue;
      separator_ = candidate;
      return;
    }
    separator_ = 0;
  }

  void take_row(Fields& fields) {
    split(line_, separator_, fields);
    if (fields.size() != log_.columns.size())
      fail(
          "{} fields where there are {} columns; correct the line (numbers take a decimal point, and fields here are "
          "separated by {})",
          fields.size(), log_.columns.size(), separator_name());
    for (std::size_t k = 0; k < fields.size(); ++k) take_field(log_.columns[k], k, fields[k]);
  }

  void take_field(LogColumn& column, std::size_t k, std::string_view field) {
    const auto value = field.empty() ? std::numeric_limits<double>::quiet_NaN() : parse_number(field);
    if (!value && column.fault.empty())
      column.fault = fmt::format(
          "line {}, column {}{}: '{}' is not a number{}; correct it, or cut the log before this "
          "line",
          number_, k + 1, column.name.empty() ? "" : fmt::format(" ({})", column.name), field,
          field.find(',') != std::string_view::npos ? " (numbers take a decimal point)" : "");
    column.values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
    if (!field.empty()) column.last_digit = std::min(column.last_digit, last_digit_of(field));
  }

  std::string_view separator_name() const {
    switch (separator_) {
      case ',':
        return "commas";
      case ';':
        return "semicolons";
      case '\t':
        return "tabs";
      default:
        return "blanks";
    }
  }

  std::string_view rest_, line_;
  std::size_t number_ = 0;
  char separator_ = 0;
  Log log_;
};

}  // namespace

Log parse_table(std::string_view text, std::string_view name) { return TableReader(text, name).read(); }

}  // namespace host
