// Tables with a header of several lines above each channel, and time columns between the channels: exports of TwinCAT 3
// Scope (layouts of its views according to the files in github.com/CagtayFabry/pytcs) and National Instruments'
// loggers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/exit_codes.hpp"
#include "host/import/log_file.hpp"
#include "host/number.hpp"
#include "host/record/table_layout.hpp"

namespace host {

namespace {

using Fields = std::vector<std::string_view>;

struct Line {
  std::size_t number = 0;
  Fields fields;
};

/// Larger stamps are FILETIME: units of 100 ns since 1601 (10^16 of them end in 1632).
constexpr double kFiletime = 1e16, kFiletime_s = 1e-7;

class BlockReader {
 public:
  BlockReader(std::string_view text, std::string_view name) : rest_(text), name_(name) {}

  std::optional<Log> read() {
    if (!find_separator() || !find_header() || !divide()) return std::nullopt;
    make_columns();
    do {
      if (trim_blanks(line_) == "EOF") break;
      take_row();
    } while (next_line());
    finish();
    return std::move(log_);
  }

 private:
  bool next_line() {
    if (!take_line(rest_, line_)) return false;
    ++number_;
    return true;
  }

  static bool is_name_key(std::string_view field) { return field == "Name" || field == "Channel name"; }

  /// Finds the separator: the character after the first field of a line with names.
  bool find_separator() {
    std::string_view rest = rest_.substr(0, kLookedAt);
    for (std::string_view line; take_line(rest, line);)
      for (const char separator : {'\t', ';', ','}) {
        const std::size_t end = line.find(separator);
        if (end == std::string_view::npos || !is_name_key(trim_blanks(line.substr(0, end)))) continue;
        layout_.separator = separator;
        return true;
      }
    return false;
  }

  /// Sets `line_` to the first row of numbers, and `header_` to the lines directly before it.
  bool find_header() {
    bool is_run = false;
    for (std::size_t k = 0; k < kMostPreamble && next_line(); ++k) {
      if (trim_blanks(line_).empty()) {
        is_run = false;
        continue;
      }
      Line line{number_, {}};
      layout_.split(line_, line.fields);
      if (is_row(line.fields)) return header_.size() >= kFewestHeaderLines;
      if (!is_run) header_.clear();
      is_run = true;
      header_.push_back(std::move(line));
      log_.preamble.emplace_back(line_.substr(0, kLongestPreamble));
    }
    return false;
  }

  /// Whether a line contains only numbers, at least two. Also finds a decimal comma.
  bool is_row(const Fields& fields) {
    std::size_t numbers = 0;
    bool commas = false;
    for (const std::string_view field : fields) {
      if (trim_blanks(field).empty()) continue;
      const bool comma = layout_.separator != ',' && field.find(',') != std::string_view::npos;
      if (!(comma ? TableLayout{layout_.separator, true, 0} : layout_).number(field)) return false;
      commas = commas || comma;
      ++numbers;
    }
    return numbers >= 2;
  }

  /// A block begins wherever the line with the names repeats its key. Every other header line must repeat its key there
  /// too.
  bool divide() {
    const auto names = std::ranges::find_if(header_, [](const Line& line) { return is_name_key(line.fields.front()); });
    if (names == header_.end()) return false;
    for (std::size_t k = 0; k < names->fields.size(); ++k)
      if (names->fields[k] == names->fields.front()) blocks_.push_back(k);
    for (const Line& line : header_)
      for (const std::size_t block : blocks_)
        if (block >= line.fields.size() || line.fields[block] != line.fields.front()) return false;
    width_ = names->fields.size();
    while (width_ > 1 && names->fields[width_ - 1].empty()) --width_;
    return true;
  }

  /// The entry of a header line for column `k`.
  std::string_view header_value(std::string_view key, std::size_t k) const {
    for (const Line& line : header_)
      if (line.fields.front().starts_with(key) && k < line.fields.size()) return line.fields[k];
    return {};
  }

  void make_columns() {
    const bool is_twincat = !header_value("SampleTime", 0).empty();
    log_.path = name_;
    log_.layout = is_twincat ? "twincat-scope" : "ni";
    log_.first_line = number_;
    log_.columns.resize(width_);
    std::string time;
    std::size_t block = 0;
    for (std::size_t k = 0; k < width_; ++k) {
      LogColumn& column = log_.columns[k];
      column.last_digit = std::numeric_limits<double>::infinity();
      if (block < blocks_.size() && blocks_[block] == k) {
        ++block;
        column.name = time = blocks_.size() == 1 ? std::string("time") : fmt::format("time({})", block);
        column.unit = std::string_view(is_twincat ? "ms" : "s");
        continue;
      }
      column.name = header_value(is_twincat ? "Name" : "Channel name", k);
      column.time = time;
      const std::string_view unit = header_value("Unit", k);
      if (unit != "(None)") column.unit = unit.substr(0, unit.find(" ("));
      symbols_.resize(width_);
      symbols_[k] = header_value("SymbolName", k);
    }
    if (is_twincat) log_.header["imported_sample_time_ms"] = header_value("SampleTime", 1);
    if (!is_twincat) log_.header["imported_interval_s"] = header_value("Interval", 1);
  }

  void take_row() {
    layout_.split(line_, fields_);
    for (std::size_t k = width_; k < fields_.size(); ++k)
      if (!trim_blanks(fields_[k]).empty())
        fail("{} fields where there are {} columns; correct the line", fields_.size(), width_);
    for (std::size_t k = 0; k < width_; ++k) take_field(k, k < fields_.size() ? fields_[k] : std::string_view());
  }

  void take_field(std::size_t k, std::string_view field) {
    LogColumn& column = log_.columns[k];
    field = trim_blanks(field);
    std::optional<double> value = std::numeric_limits<double>::quiet_NaN();
    if (!field.empty()) {
      const TableLayout layout{layout_.separator, layout_.separator != ',' && field.find(',') != std::string_view::npos,
                               0};
      value = layout.number(field);
      if (value) column.last_digit = std::min(column.last_digit, layout.last_digit(field));
      if (!value && column.fault.empty())
        column.fault =
            fmt::format("line {}, column {} ({}): '{}' is not a number; correct it, or cut the log before it", number_,
                        k + 1, column.name, field);
    }
    column.values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
  }

  void finish() {
    for (std::size_t k = 0; k < width_; ++k) {
      LogColumn& column = log_.columns[k];
      const bool is_time = column.time.empty();
      if (is_time && !column.values.empty() && column.values.front() > kFiletime) count_from_start(column);
      column.kind =
          fmt::format("{} {}{}{}", column.values.size(), is_time ? "times" : "numbers",
                      column.unit.empty() ? std::string() : fmt::format(", {}", column.unit),
                      k < symbols_.size() && !symbols_[k].empty() ? fmt::format(", {}", symbols_[k]) : std::string());
    }
  }

  static void count_from_start(LogColumn& column) {
    const double first = column.values.front();
    for (double& value : column.values) value = (value - first) * kFiletime_s;
    column.unit = 's';
    column.last_digit = 16.0 * kFiletime_s;  // resolution of a double for a number of this size
  }

  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: line {}: {}", name_, number_, fmt::format(format, std::forward<Args>(args)...)));
  }

  static constexpr std::size_t kLookedAt = 64 * 1024, kFewestHeaderLines = 3;

  std::string_view rest_, name_, line_;
  TableLayout layout_;
  std::size_t number_ = 0, width_ = 0;
  std::vector<Line> header_;
  std::vector<std::size_t> blocks_;
  std::vector<std::string> symbols_;
  Fields fields_;
  Log log_;
};

}  // namespace

std::optional<Log> parse_channel_blocks(std::string_view text, std::string_view name) {
  return BlockReader(text, name).read();
}

}  // namespace host
