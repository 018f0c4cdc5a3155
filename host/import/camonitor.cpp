// EPICS camonitor: one line for each new value of a process variable, "NAME DATE TIME VALUE [STATUS SEVERITY]".
#include <fmt/format.h>

#include <map>

#include "host/import/log_file.hpp"
#include "host/number.hpp"
#include "host/record/clock.hpp"
#include "host/record/table_layout.hpp"

namespace host {

namespace {

struct Reading {
  std::string_view name;
  ClockReading when;
  double value = 0.0;
};

std::optional<Reading> parse_reading(std::string_view line, std::vector<std::string_view>& fields) {
  TableLayout{}.split(line, fields);
  if (fields.size() < 4) return std::nullopt;
  const std::optional<ClockReading> day = parse_clock(fields[1]), time = parse_clock(fields[2]);
  const std::optional<double> value = parse_number(fields[3]);
  if (!day || !day->day || day->second != 0.0 || !time || time->day || !value) return std::nullopt;
  Reading reading{fields[0], *time, *value};
  reading.when.day = day->day;
  return reading;
}

/// Whether nine of ten of the first non-empty lines are readings (others are "*** not connected").
bool is_camonitor(std::string_view text) {
  constexpr std::size_t kLooked = 20;
  std::vector<std::string_view> fields;
  std::size_t lines = 0, readings = 0;
  for (std::string_view line; lines < kLooked && take_line(text, line);) {
    if (trim_blanks(line).empty()) continue;
    ++lines;
    if (parse_reading(line, fields)) ++readings;
  }
  return readings >= 2 && 10 * readings >= 9 * lines;
}

class Collector {
 public:
  explicit Collector(std::string_view name) { log_.path = name; }

  void take(const Reading& reading) {
    constexpr double kDay_s = 86'400.0;
    if (!first_day_) first_day_ = *reading.when.day;
    const auto [at, is_new] = place_.emplace(reading.name, log_.columns.size());
    if (is_new) add(reading.name);
    LogColumn &time = log_.columns[at->second], &value = log_.columns[at->second + 1];
    time.values.push_back(kDay_s * static_cast<double>(*reading.when.day - *first_day_) + reading.when.second);
    time.last_digit = reading.when.last_digit;
    value.values.push_back(reading.value);
  }

  void skip() { ++skipped_; }

  Log finish() {
    log_.layout = "camonitor";
    if (skipped_ > 0) log_.header["imported_without"] = fmt::format("{} lines without a number", skipped_);
    for (LogColumn& column : log_.columns)
      column.kind = fmt::format("{} {}", column.values.size(),
                                column.time.empty() ? "times, s from the first day's midnight" : "numbers");
    return std::move(log_);
  }

 private:
  void add(std::string_view name) {
    LogColumn time, value;
    time.name = fmt::format("time of {}", name);
    time.unit = 's';
    value.name = name;
    value.time = time.name;
    log_.columns.push_back(std::move(time));
    log_.columns.push_back(std::move(value));
  }

  Log log_;
  std::map<std::string, std::size_t, std::less<>> place_;
  std::optional<std::int64_t> first_day_;
  std::size_t skipped_ = 0;
};

}  // namespace

std::optional<Log> parse_camonitor(std::string_view text, std::string_view name) {
  if (!is_camonitor(text)) return std::nullopt;
  Collector collector(name);
  std::vector<std::string_view> fields;
  for (std::string_view line; take_line(text, line);) {
    if (const std::optional<Reading> reading = parse_reading(line, fields))
      collector.take(*reading);
    else if (!trim_blanks(line).empty())
      collector.skip();
  }
  return collector.finish();
}

}  // namespace host
