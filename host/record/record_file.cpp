#include "host/record/record_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/exit_codes.hpp"
#include "host/input_limits.hpp"
#include "host/number.hpp"
#include "host/record/read_record.hpp"
#include "host/record/table_layout.hpp"

namespace host {

namespace {

/// Places for rows, including lost ones, and channels together. A pyramid of them takes 130 MB.
constexpr std::uint64_t kMostPlaces = 4 * kMostLogNumbers;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

template <typename... Args>
[[noreturn]] void fail_file(const std::string& path, fmt::format_string<Args...> format, Args&&... args) {
  throw Failure(ExitCode::bad_input, fmt::format("{}: {}", path, fmt::format(format, std::forward<Args>(args)...)));
}

FileStamp stamp_of(const struct stat& told) {
  return {static_cast<std::uint64_t>(told.st_dev), static_cast<std::uint64_t>(told.st_ino),
          static_cast<std::uint64_t>(told.st_size), told.st_mtim.tv_sec, told.st_mtim.tv_nsec};
}

/// Takes a field and the comma behind it from a line; NaN if it is not a finite number. False at the end of the line.
bool take_value(std::string_view& line, double& value) {
  const auto [end, problem] = std::from_chars(line.data(), line.data() + line.size(), value);
  const auto used = static_cast<std::size_t>(end - line.data());
  if (problem == std::errc{} && used < line.size() && line[used] == ',' && std::isfinite(value)) {
    line.remove_prefix(used + 1);
    return true;
  }
  const std::size_t comma = line.find(',');
  value = parse_number(line.substr(0, comma)).value_or(kNotANumber);
  if (!std::isfinite(value)) value = kNotANumber;
  line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
  return comma != std::string_view::npos;
}

}  // namespace

FileStamp file_stamp(const std::string& path) {
  struct stat told {};
  if (::stat(path.c_str(), &told) != 0) fail_file(path, "cannot read: {}; check the name", std::strerror(errno));
  return stamp_of(told);
}

RecordFile::RecordFile(const std::string& path) : path_(path), file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (file_ < 0) fail_file(path, "cannot read: {}; check the name and its rights", std::strerror(errno));
  try {
    struct stat told {};
    if (::fstat(file_, &told) != 0 || !S_ISREG(told.st_mode)) fail_file(path, "is not a file");
    stamp_ = stamp_of(told);
    if (stamp_.bytes > kRecordSize.bytes)
      fail_file(path, "larger than {} MiB, the most that {} may have; cut it", kRecordSize.bytes / kMebibyte,
                kRecordSize.of);
    read_head();
    read_time_base();
  } catch (...) {
    ::close(file_);
    throw;
  }
}

RecordFile::~RecordFile() { ::close(file_); }

std::size_t RecordFile::blocks() const { return (stamp_.bytes - head_.size() + kBlock - 1) / kBlock; }

std::string RecordFile::bytes(std::uint64_t begin, std::size_t size) const {
  std::string text(std::min<std::uint64_t>(size, stamp_.bytes - std::min(begin, stamp_.bytes)), 0);
  for (std::size_t got = 0; got < text.size();) {
    const ssize_t more = ::pread(file_, text.data() + got, text.size() - got, static_cast<off_t>(begin + got));
    if (more <= 0) fail_file(path_, "has changed while it was read; open it again");
    got += static_cast<std::size_t>(more);
  }
  struct stat told {};
  if (::fstat(file_, &told) != 0 || stamp_of(told) != stamp_)
    fail_file(path_, "has changed while it was read; open it again");
  return text;
}

void RecordFile::read_head() {
  const std::string begin = bytes(0, kLongestLine);
  std::string_view rest = begin, line;
  std::size_t number = 0;
  while (take_line(rest, line) && ++number > 0 && line.starts_with('#')) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || trim_blanks(line.substr(1, colon - 1)) != "sample_period_s") continue;
    header_period_s_ = parse_number(line.substr(colon + 1)).value_or(0.0);
  }
  head_ = begin.substr(0, begin.size() - rest.size());
  bool has_time = false;
  for (std::size_t place = 0; !line.empty(); ++place) {
    const std::size_t comma = std::min(line.find(','), line.size());
    const std::string name(trim_blanks(line.substr(0, comma)));
    if (name != "t_s" || has_time) {
      columns_.push_back(name);
    } else {
      time_column_ = place;
      has_time = true;
    }
    line.remove_prefix(std::min(comma + 1, line.size()));
  }
  if (!has_time || columns_.empty())
    fail_file(path_, "line {}: expected the column names, t_s and at least one channel, such as t_s,u_V,x_mm", number);
}

double RecordFile::time_of(std::string_view line) const {
  double value = kNotANumber;
  for (std::size_t place = 0; place <= time_column_; ++place) {
    const bool is_more = take_value(line, value);
    if (place < time_column_ && !is_more) return kNotANumber;
  }
  return value;
}

/// The period is the median step of the first rows. It is refined so that the last stamp lies on a row, because over
/// millions of rows the rounding of the stamps would add up.
void RecordFile::read_time_base() {
  std::vector<double> stamps;
  const auto stamps_of = [&](const std::string& lines) {
    stamps.clear();
    for (std::string_view rest = lines, line; take_line(rest, line);)
      if (const double t_s = time_of(line); std::isfinite(t_s)) stamps.push_back(t_s);
  };
  const std::size_t count = blocks();
  if (count == 0) fail_file(path_, "no rows follow the column names; the record is empty, record again");
  stamps_of(block(0));
  if (stamps.size() < kFewestRows)
    fail_file(path_, "fewer than {} rows have a time in t_s; record for longer, or correct the column", kFewestRows);
  start_s_ = stamps.front();
  std::vector<double> steps;
  for (std::size_t k = 1; k < stamps.size(); ++k) steps.push_back(stamps[k] - stamps[k - 1]);
  std::ranges::nth_element(steps, steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2));
  const double median_s = steps[steps.size() / 2];
  const double mean_s = (stamps.back() - stamps.front()) / static_cast<double>(steps.size());
  // The mean of rounded stamps is closer to the period, unless samples are missing.
  const double step_s = std::abs(mean_s - median_s) < 0.5 * median_s ? mean_s : median_s;
  period_s_ = std::isfinite(header_period_s_) && header_period_s_ > 0.0 ? header_period_s_ : step_s;
  for (std::size_t k = count; k-- > 0;) {
    stamps_of(block(k));
    if (!stamps.empty()) break;
  }
  const double lasts_s = stamps.back() - start_s_, periods = std::round(lasts_s / period_s_);
  if (!(period_s_ > 0.0) || !(periods >= 1.0))
    fail_file(path_, "t_s does not increase from {} s at the first row to {} s at the last; correct it", start_s_,
              stamps.back());
  if (!(periods * static_cast<double>(columns_.size()) < static_cast<double>(kMostPlaces)))
    fail_file(path_, "t_s lasts {} s, {} sample periods of {} s: more than a picture may have; cut it at the gap",
              lasts_s, periods, period_s_);
  period_s_ = lasts_s / periods;
  rows_ = static_cast<std::uint64_t>(periods) + 1;
}

std::string RecordFile::block(std::size_t index) const {
  // The byte before the block tells whether a line begins with it.
  const std::uint64_t begin = head_.size() + index * std::uint64_t{kBlock}, before = begin - (index > 0 ? 1 : 0);
  std::string text = bytes(before, kBlock + static_cast<std::size_t>(begin - before));
  constexpr std::size_t kMore = 4096;
  while (!text.ends_with('\n') && before + text.size() < stamp_.bytes) {
    if (text.size() > kBlock + kLongestLine)
      fail_file(path_, "no text: a line is longer than {} MiB, the most that {} may have", kLongestLine / kMebibyte,
                kRecordSize.of);
    std::string more = bytes(before + text.size(), kMore);
    text += more.substr(0, std::min(more.find('\n'), more.size() - 1) + 1);
  }
  if (index == 0) return text;
  const std::size_t first = text.find('\n');
  // A line that covers the whole block began before it.
  return first == std::string::npos || first > kBlock ? "" : text.substr(first + 1);
}

/// Reads the fields of a line; false if it has too few or too many.
bool RecordFile::take_fields(std::string_view line, double& t_s, std::vector<double>& values) const {
  bool is_more = true;
  for (std::size_t place = 0, channel = 0; place <= values.size(); ++place) {
    if (!is_more) return false;
    is_more = take_value(line, place == time_column_ ? t_s : values[channel++]);
  }
  return !is_more;
}

RecordFile::Faults RecordFile::each_row(std::string_view lines, const Row& take) const {
  Faults faults;
  std::vector<double> values(columns_.size());
  std::uint64_t least = 0;
  for (std::string_view line; take_line(lines, line);) {
    double t_s = kNotANumber;
    const bool is_whole = take_fields(line, t_s, values);
    const double number = std::round((t_s - start_s_) / period_s_);
    if (!is_whole || !(number >= static_cast<double>(least)) || !(number < static_cast<double>(rows_))) {
      ++faults.rows;
      continue;
    }
    faults.fields += static_cast<std::uint64_t>(std::ranges::count_if(values, [](double v) { return std::isnan(v); }));
    least = static_cast<std::uint64_t>(number);
    take(least, values);
  }
  return faults;
}

}  // namespace host
