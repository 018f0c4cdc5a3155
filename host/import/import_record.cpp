#include "host/import/import_record.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "host/exit_codes.hpp"
#include "host/nearest_name.hpp"
#include "host/number.hpp"
#include "host/record/channel_checks.hpp"
#include "host/record/columns.hpp"
#include "host/record/read_record.hpp"
#include "host/record/resample.hpp"
#include "host/record/time_axis.hpp"

namespace host {

namespace {

/// One column of the record while it is being made: the numbers of its source and their time stamps.
struct Source {
  const Mapping* mapping = nullptr;
  const LogColumn* column = nullptr;  ///< null for the row number
  std::vector<double> raw;
  StampedChannel stamped;
  std::size_t blanks = 0;  ///< rows without a value (slower channels of a multi-rate log)
};

class Importer {
 public:
  Importer(const Log& log, const ImportOptions& options) : log_(log), options_(options), mappings_(options.mappings) {
    record_.path = log.path;
    if (!options.resample_period_s && log.first_line > 0) record_.names_line = log.first_line - 1;
    if (mappings_.empty()) keep_names();
  }

  Record run() {
    check_names();
    find_sources();
    refuse_copies();
    if (options_.resample_period_s)
      resample(*options_.resample_period_s);
    else
      take_as_it_is();
    write_header();
    if (record_.size() < kFewestRows)
      fail("the record would hold {} rows, but at least {} are needed; log for longer", record_.size(), kFewestRows);
    check_channels(record_);
    return std::move(record_);
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: {}", log_.path, fmt::format(format, std::forward<Args>(args)...)));
  }

  void keep_names() {
    for (const LogColumn& column : log_.columns) {
      if (find_known_column(column.name) == nullptr && !column.fault.empty()) continue;
      if (!column.name.empty()) mappings_.push_back({column.name, column.name, {}, 1.0, 0.0});
    }
    if (std::ranges::none_of(mappings_, [](const Mapping& m) { return m.column == "t_s"; }))
      fail("no column is called t_s, so assign the columns: --map t_s=…,u_V=…,x_mm=…; there is {}", log_.inventory());
  }

  void check_names() const {
    std::vector<std::string_view> names, known;
    for (const Mapping& mapping : mappings_) names.push_back(mapping.column);
    for (const KnownColumn& column : kKnownColumns) known.push_back(column.name);
    const std::string fault = fault_of_columns(names);
    if (fault.empty()) return;
    std::string hint;
    for (const std::string_view name : names)
      if (find_known_column(name) == nullptr) hint += did_you_mean(name, known);
    fail("{}{}; there is {}", fault, hint, log_.inventory());
  }

  void find_sources() {
    sources_.reserve(mappings_.size());
    for (const Mapping& mapping : mappings_) {
      Source source;
      source.mapping = &mapping;
      if (mapping.source != kRowSource || has_column(kRowSource)) source.column = &usable(mapping.source);
      if (source.column != nullptr) source.raw = source.column->values;
      sources_.push_back(std::move(source));
    }
    for (Source& source : sources_) {
      if (source.column != nullptr) continue;
      source.raw.resize(longest());
      std::iota(source.raw.begin(), source.raw.end(), 0.0);
    }
    if (longest() == 0) fail("the log is empty; record it again");
    time_ = &*std::ranges::find(sources_, std::string_view("t_s"), [](const Source& s) { return s.mapping->column; });
    if (!time_->mapping->time_source.empty()) fail("t_s cannot have separate time stamps; remove the '@' after it");
    for (Source& source : sources_) stamp(source);
    for (const Unwrapping& unwrapping : options_.unwrap) unwrap(unwrapping);
  }

  /// A step of more than half the range is a wrap.
  void unwrap(const Unwrapping& unwrapping) {
    const auto source = std::ranges::find(sources_, std::string_view(unwrapping.column),
                                          [](const Source& s) { return std::string_view(s.mapping->column); });
    if (source == sources_.end() || unwrapping.column == "t_s")
      throw Failure(ExitCode::usage, fmt::format("--unwrap {}: the record has no such channel", unwrapping.column));
    std::vector<double>& values = source->stamped.values;
    const auto [low, high] = std::ranges::minmax(values);
    constexpr double kRounding = 1.001;
    if (high - low > kRounding * unwrapping.range)
      fail(
          "--unwrap {}={}: the column covers {:.6g}, more than this range, so it does not wrap there; give its range "
          "in the record's unit",
          unwrapping.column, unwrapping.range, high - low);
    double turns = 0.0, before = values.front();
    std::size_t wraps = 0;
    for (double& value : values) {
      const double step = value - before;
      before = value;
      if (std::abs(step) > 0.5 * unwrapping.range) {
        turns -= std::copysign(1.0, step);
        ++wraps;
      }
      value += turns * unwrapping.range;
    }
    record_.header["unwrapped_" + unwrapping.column] = fmt::format("{} times by {}", wraps, unwrapping.range);
  }

  bool has_column(std::string_view name) const {
    return std::ranges::find(log_.columns, name, &LogColumn::name) != log_.columns.end();
  }

  const LogColumn& usable(const std::string& name) const {
    const LogColumn& column = log_.find(name);
    if (!column.fault.empty()) fail("{}", column.fault);
    return column;
  }

  std::size_t longest() const {
    std::size_t length = 0;
    for (const Source& source : sources_) length = std::max(length, source.raw.size());
    return length;
  }

  /// Scales the values of the source and adds their stamps. Rows without a value are left out.
  void stamp(Source& source) {
    const bool own_time = !source.mapping->time_source.empty();
    const std::vector<double>& stamps = own_time ? usable(source.mapping->time_source).values : time_->raw;
    if (stamps.size() != source.raw.size())
      fail(
          "lengths differ: {} has {} values, {} has {} time stamps; name its separate time stamps ({}={}@…) and "
          "--resample, or cut both to one length",
          source.mapping->source, source.raw.size(), own_time ? source.mapping->time_source : time_->mapping->source,
          stamps.size(), source.mapping->column, source.mapping->source);
    for (std::size_t k = 0; k < stamps.size(); ++k) {
      const double t_s = time_->mapping->apply(stamps[k]), value = source.mapping->apply(source.raw[k]);
      const bool blank = std::isnan(value) && options_.resample_period_s.has_value() && &source != time_;
      if (blank) {
        ++source.blanks;
        continue;
      }
      if (!std::isfinite(value) || !std::isfinite(t_s)) fail_value(source, k, std::isfinite(t_s) ? value : t_s);
      source.stamped.t_s.push_back(t_s);
      source.stamped.values.push_back(value);
    }
  }

  std::string place(std::size_t row) const {
    return log_.first_line > 0 ? fmt::format("line {}", log_.first_line + row) : fmt::format("sample {}", row + 1);
  }

  [[noreturn]] void fail_value(const Source& source, std::size_t row, double value) const {
    if (std::isnan(value) && &source != time_)
      fail(
          "{}, {}: NaN or no value; correct it, cut the log there, or use --resample if the channel was logged more "
          "slowly",
          place(row), source.mapping->source);
    fail("{}, {}: {} is not a measured value; correct it, or cut the log there", place(row), source.mapping->source,
         value);
  }

  /// One channel of the log under two names would count twice.
  void refuse_copies() const {
    std::vector<NamedColumn> raw;
    for (const Source& source : sources_)
      if (find_known_column(source.mapping->column) != nullptr) raw.push_back({source.mapping->column, source.raw});
    if (const std::string fault = fault_of_copies(raw); !fault.empty()) fail("{}", fault);
  }

  TimeAxis axis_of(const Source& source) const {
    const LogColumn* column = time_->column;
    const double digit = column == nullptr ? 0.0 : column->last_digit * std::abs(time_->mapping->factor);
    return {source.stamped.t_s, source.blanks == 0 && std::isfinite(digit) ? digit : 0.0,
            source.blanks == 0 ? log_.first_line : 0};
  }

  void take_as_it_is() {
    for (const Source& source : sources_)
      if (source.stamped.t_s != time_->stamped.t_s)
        fail("{} has separate time stamps that differ from those of t_s; resample with --resample PERIOD",
             source.mapping->column);
    record_.sample_period_s = check_time_axis(axis_of(*time_), {}, 0, log_.path);
    for (Source& source : sources_) place_values(source, source.stamped.values);
    fill_channels(std::move(known_), record_);
  }

  void place_values(const Source& source, std::vector<double> values) {
    if (find_known_column(source.mapping->column) != nullptr)
      known_.push_back({source.mapping->column, std::move(values)});
    else
      record_.extra.push_back({source.mapping->column, std::move(values), {}});
  }

  void resample(double period_s) {
    double start = time_->stamped.t_s.front(), end = time_->stamped.t_s.back();
    for (const Source& source : sources_) {
      if (source.stamped.t_s.size() < 2) fail("{} holds fewer than two values; leave it out", source.mapping->source);
      check_time_increases(axis_of(source), log_.path);
      start = std::max(start, source.stamped.t_s.front());
      end = std::min(end, source.stamped.t_s.back());
    }
    if (!(end > start)) fail("the channels have no time in common; check their time stamps");
    refuse_hopeless(period_s, end - start);
    const std::vector<double> grid = even_grid(start, end, period_s);
    for (Source& source : sources_) {
      const bool is_time = &source == time_;
      const bool is_held = source.mapping->column == "u_V";
      place_values(source, is_time   ? grid
                           : is_held ? mean_of_held(source.stamped, grid, period_s)
                                     : interpolate(source.stamped, grid));
    }
    record_.sample_period_s = period_s;
    fill_channels(std::move(known_), record_);
    state_what_was_done(period_s, start, end);
  }

  /// Limits resampling: more than ten times the number of logged samples would add no information, and with a mistyped
  /// period they would fill the memory.
  void refuse_hopeless(double period_s, double length_s) const {
    constexpr double kMostPerSample = 10.0;
    const double finest = static_cast<double>(longest()) * kMostPerSample;
    if (length_s / period_s > finest)
      fail(
          "--resample {}: this would make {:.3g} samples from {}; give a period in seconds near that of the log, "
          "{:.3g}",
          period_s, length_s / period_s, longest(), measure_spacing(axis_of(*time_)).period_s);
    if (period_s * static_cast<double>(kFewestRows) > length_s)
      fail("--resample {}: the log lasts {:.3g} s, which leaves fewer than {} rows; give a shorter period, in seconds",
           period_s, length_s, kFewestRows);
  }

  void state_what_was_done(double period_s, double start, double end) {
    const Spacing spacing = measure_spacing(axis_of(*time_));
    record_.header["resampled"] =
        fmt::format("to {} s from {} rows of {:.6g} s; {} s to {} s; jitter {:.3g} ms rms, {:.3g} ms at worst",
                    period_s, time_->stamped.t_s.size(), spacing.period_s, start, end, spacing.rms_jitter_s * 1e3,
                    spacing.worst_jitter_s * 1e3);
    record_.header["resampled_gaps"] =
        spacing.gaps == 0
            ? "none"
            : fmt::format("{} gap(s), {} sample(s) missing, the longest {:.6g} s; filled by interpolation",
                          spacing.gaps, spacing.dropped, longest_step());
    record_.header["resampled_by"] =
        "straight lines between samples; for u_V, which is held between rows, the mean over each new period";
    for (const Source& source : sources_)
      if (source.blanks > 0 || !source.mapping->time_source.empty())
        record_.header[fmt::format("resampled_{}", source.mapping->column)] =
            fmt::format("{} values of a median spacing of {:.6g} s", source.stamped.values.size(),
                        measure_spacing(axis_of(source)).period_s);
  }

  double longest_step() const {
    const std::vector<double>& t = time_->stamped.t_s;
    double longest = 0.0;
    for (std::size_t k = 1; k < t.size(); ++k) longest = std::max(longest, t[k] - t[k - 1]);
    return longest;
  }

  void write_header() {
    for (const auto& [key, value] : log_.header)
      if (key != "format" && key != "sample_period_s" && key != "drive") record_.header.emplace(key, value);
    const auto drive = log_.header.find("drive");
    record_.drive = !options_.drive.empty() || drive == log_.header.end() ? options_.drive : drive->second;
    std::vector<std::string> origins;
    for (const Mapping& m : mappings_)
      origins.push_back(fmt::format(
          "{}={}{}{}{}", m.column, m.source, m.factor == 1.0 ? "" : fmt::format("*{}", m.factor),
          m.shift == 0.0 ? "" : fmt::format("{:+}", m.shift), m.time_source.empty() ? "" : "@" + m.time_source));
    record_.header["imported_from"] = std::filesystem::path(log_.path).filename().string();
    record_.header["imported_as"] = fmt::format("{}", fmt::join(origins, ","));
  }

  const Log& log_;
  const ImportOptions& options_;
  std::vector<Mapping> mappings_;
  std::vector<Source> sources_;
  std::vector<NamedColumn> known_;
  const Source* time_ = nullptr;
  Record record_;
};

}  // namespace

Unwrapping parse_unwrapping(std::string_view text) {
  const std::optional<NamedNumber> column = parse_named_number(text);
  if (!column)
    throw Failure(ExitCode::usage,
                  fmt::format("--unwrap {}: write COLUMN=RANGE with a range above 0, e.g. x_mm=6.2831853", text));
  return {column->name, column->value};
}

Record import_record(const Log& log, const ImportOptions& options) { return Importer(log, options).run(); }

}  // namespace host
