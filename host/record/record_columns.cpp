#include "host/record/record_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "host/exit_codes.hpp"
#include "host/number.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/columns.hpp"
#include "host/record/log_fault.hpp"
#include "host/record/read_record.hpp"
#include "host/record/time_axis.hpp"

namespace host {

namespace {

template <typename... Args>
[[noreturn]] void fail(const std::string& name, fmt::format_string<Args...> format, Args&&... args) {
  throw Failure(ExitCode::bad_input, fmt::format("{}: {}", name, fmt::format(format, std::forward<Args>(args)...)));
}

/// The sample period in the header, if there is one.
std::optional<double> take_header(const RecordColumns& given, Record& record) {
  std::optional<double> period_s;
  for (const auto& [key, value] : given.header) {
    if (key == "format" && value != "axis-record/1")
      fail(record.path, "format '{}' is unknown; this program reads axis-record/1", value);
    if (key == "drive") record.drive = value;
    if (key == "sample_period_s") {
      period_s = parse_number(value);
      if (!period_s || !std::isfinite(*period_s) || *period_s <= 0.0)
        fail(record.path, "sample_period_s: '{}' is not a positive number of seconds; correct it or leave it out",
             value);
    }
  }
  record.header = given.header;
  record.header.emplace("format", "axis-record/1");
  return period_s;
}

void require_measured(const std::string& path, const std::string& column, const std::vector<double>& values) {
  const auto fault = std::ranges::find_if_not(values, [](double value) { return std::isfinite(value); });
  if (fault == values.end()) return;
  fail(path, "row {}, column {}: {} is not a measured value; correct it, or cut the record before this row",
       fault - values.begin(), column, *fault);
}

}  // namespace

Record record_of(RecordColumns given, const std::string& name) {
  Record record;
  record.path = name;
  const std::optional<double> period_s = take_header(given, record);
  if (given.columns.empty()) fail(name, "there are no columns; give t_s, u_V, x_mm, …");
  std::vector<std::string_view> names;
  for (const auto& [column, values] : given.columns) {
    names.push_back(column);
    if (values.size() != given.columns.front().second.size())
      fail(name, "the columns of a record must have the same length; {} has {} rows, {} has {}", names.front(),
           given.columns.front().second.size(), column, values.size());
  }
  if (const std::string fault = fault_of_columns(names); !fault.empty()) fail(name, "{}", fault);
  std::vector<NamedColumn> known;
  for (auto& [column, values] : given.columns) {
    if (const KnownColumn* found = find_known_column(column)) {
      require_measured(name, column, values);
      known.push_back({found->name, std::move(values)});
    } else {
      record.extra.push_back({column, std::move(values), {}});
    }
  }
  if (const std::string fault = fault_of_copies(known); !fault.empty()) {
    const std::string message = fmt::format("{}: {}", name, fault);
    throw FaultyLog(message, {{LogFaultKind::copied_channel, {}, name, 0.0, 0.0, message}});
  }
  fill_channels(std::move(known), record);
  if (record.size() < kFewestRows)
    fail(name, "the record ends after {} rows, too short: at least {} are needed; record for longer", record.size(),
         kFewestRows);
  double digit = std::numeric_limits<double>::infinity();
  for (const double t : record.t_s) digit = std::min(digit, last_digit_of(fmt::format("{}", t)));
  record.sample_period_s = check_time_axis({record.t_s, digit, 0}, period_s, 0, name);
  check_channels(record);
  return record;
}

RecordColumns columns_of(const Record& record) {
  RecordColumns result;
  result.header = record.header;
  result.header["format"] = "axis-record/1";
  if (!record.drive.empty()) result.header["drive"] = record.drive;
  result.header["sample_period_s"] = fmt::format("{}", record.sample_period_s);
  for (const auto channel : kChannelsInFileOrder)
    if (!(record.*channel).empty()) result.columns.emplace_back(column_name(channel, record.kind), record.*channel);
  for (const ExtraChannel& extra : record.extra) result.columns.emplace_back(extra.name, extra.values);
  return result;
}

}  // namespace host
