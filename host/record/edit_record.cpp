#include "host/record/edit_record.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "host/exit_codes.hpp"
#include "host/nearest_name.hpp"
#include "host/number.hpp"
#include "host/record/columns.hpp"
#include "host/record/read_record.hpp"
#include "host/record/resample.hpp"
#include "host/record/table_layout.hpp"
#include "host/record/text_encoding.hpp"

namespace host {

namespace {

template <typename... Args>
[[noreturn]] void fail_for(const Record& record, fmt::format_string<Args...> format, Args&&... args) {
  throw Failure(ExitCode::usage, fmt::format("{}: {}", record.path, fmt::format(format, std::forward<Args>(args)...)));
}

template <typename Value>
void keep(std::vector<Value>& values, std::size_t begin, std::size_t end) {
  if (values.empty()) return;
  values.erase(values.begin() + static_cast<std::ptrdiff_t>(end), values.end());
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(begin));
}

void keep_rows(Record& record, std::size_t begin, std::size_t end) {
  if (end < begin + kFewestRows)
    fail_for(record, "{} rows would remain, but at least {} are needed; the record lasts from {} s to {} s",
             end > begin ? end - begin : 0, kFewestRows, record.t_s.front(), record.t_s.back());
  for (const auto channel : kChannelsInFileOrder) keep(record.*channel, begin, end);
  for (ExtraChannel& extra : record.extra) {
    keep(extra.values, begin, end);
    keep(extra.text, begin, end);
  }
}

/// Adds a note under a key of its own, even if the record has been edited before.
void note(Record& record, const std::string& key, const std::string& what) {
  std::string free = key;
  for (int number = 2; record.header.contains(free); ++number) free = fmt::format("{}_{}", key, number);
  record.header[free] = what;
}

/// The numbers of a channel, by its name in the file or in the format.
std::vector<double>& channel_of(Record& record, std::string_view name) {
  std::vector<std::string_view> names;
  for (const auto channel : kChannelsInFileOrder) {
    if ((record.*channel).empty()) continue;
    for (const std::string_view own : {column_name(channel, record.kind), name_in_file(record, channel)}) {
      if (name == own && channel != &Record::t_s) return record.*channel;
      names.push_back(own);
    }
  }
  for (ExtraChannel& extra : record.extra) {
    names.push_back(extra.name);
    if (name != extra.name) continue;
    if (!extra.text.empty()) fail_for(record, "{} holds text, which cannot be interpolated between rows", name);
    return extra.values;
  }
  if (name == "t_s") fail_for(record, "t_s itself cannot be shifted; name another channel");
  fail_for(record, "there is no channel {}{}; there is {}", name, did_you_mean(name, names), fmt::join(names, ", "));
}

/// The text of a record in two parts: the text above its rows, and the lines from the first to the last selected row.
struct RowsInTime {
  std::string_view head, kept;
  double first_s = std::nan(""), last_s = std::nan("");  ///< times of the first and last row
};

std::string_view field(std::string_view line, std::size_t number) {
  for (; number > 0; --number) line.remove_prefix(std::min(line.find(',') + 1, line.size()));
  return line.substr(0, line.find(','));
}

std::size_t time_column(std::string_view names) {
  const std::size_t columns = static_cast<std::size_t>(std::ranges::count(names, ',')) + 1;
  for (std::size_t k = 0; k < columns; ++k)
    if (trim_blanks(field(names, k)) == "t_s") return k;
  return 0;  // the reader reports the missing column
}

RowsInTime rows_in_time(std::string_view text, double from_s, double to_s) {
  RowsInTime rows;
  std::string_view rest = text, line;
  while (take_line(rest, line) && line.starts_with('#')) continue;
  const std::size_t column = time_column(line);
  rows.head = text.substr(0, text.size() - rest.size());
  const double slack = 1e-9 * std::max(1.0, std::min(std::abs(from_s), std::abs(to_s)));  // stamps are decimal
  const char *begin = nullptr, *end = nullptr;
  while (!rest.empty()) {
    const char* const here = rest.data();
    take_line(rest, line);
    const std::optional<double> t_s = parse_number(field(line, column));
    if (!t_s || !std::isfinite(*t_s)) continue;
    if (std::isnan(rows.first_s)) rows.first_s = *t_s;
    rows.last_s = *t_s;
    if (*t_s < from_s - slack || *t_s > to_s + slack) continue;
    if (begin == nullptr) begin = here;
    end = rest.data();
  }
  if (begin != nullptr) rows.kept = {begin, static_cast<std::size_t>(end - begin)};
  return rows;
}

}  // namespace

Record cut_record(std::string_view text, const std::string& name, double from_s, double to_s) {
  if (!(from_s < to_s))
    throw Failure(ExitCode::usage, fmt::format("{}: --from {} s is not before --to {} s", name, from_s, to_s));
  const std::string plain = as_utf8(std::string(text));
  const RowsInTime rows = rows_in_time(plain, from_s, to_s);
  if (rows.kept.empty())
    throw Failure(ExitCode::usage, fmt::format("{}: no row lies between {} s and {} s; t_s goes from {} to {}", name,
                                               from_s, to_s, rows.first_s, rows.last_s));
  Record cut = parse_record(std::string(rows.head) + std::string(rows.kept), name);
  note(cut, "cut",
       fmt::format("{} s to {} s of {}", cut.t_s.front(), cut.t_s.back(),
                   std::filesystem::path(name).filename().string()));
  return cut;
}

Record shift_channel(const Record& record, std::string_view name, double by_s) {
  Record shifted = record;
  std::vector<double>& values = channel_of(shifted, name);
  const bool held = &values == &shifted.u_V;
  const double period_s = record.sample_period_s, rows = static_cast<double>(record.size());
  if (!(std::abs(by_s) < period_s * rows)) fail_for(record, "{} s is longer than the record", by_s);
  StampedChannel moved{record.t_s, values};
  for (double& t : moved.t_s) t += by_s;
  const double slack = 1e-6 * period_s;
  std::size_t begin = 0, end = record.size();
  while (begin < end && record.t_s[begin] < moved.t_s.front() - slack) ++begin;
  // A held value is valid for one period after its stamp.
  while (end > begin && record.t_s[end - 1] > moved.t_s.back() + (held ? 0.0 : slack)) --end;
  keep_rows(shifted, begin, end);
  values = held ? mean_of_held(moved, shifted.t_s, period_s) : interpolate(moved, shifted.t_s);
  const bool whole = std::abs(std::remainder(by_s, period_s)) <= slack;
  note(shifted, "shifted",
       fmt::format("{} by {:+} s{}; {} rows at the ends cut off", name, by_s,
                   whole  ? ""
                   : held ? ", by the mean over each period"
                          : ", by straight lines between samples",
                   record.size() - shifted.size()));
  return shifted;
}

}  // namespace host
