#include "host/opening/opening.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "host/atomic_file.hpp"
#include "host/exit_codes.hpp"
#include "host/opening/hal_file.hpp"
#include "host/opening/mapping_file.hpp"
#include "host/opening/next_run.hpp"
#include "host/read_file.hpp"
#include "host/record/columns.hpp"
#include "host/record/read_record.hpp"

namespace host {

namespace {

/// Shorter runs cannot be identified at any rate of a controller.
constexpr std::size_t kFewestRowsOfARun = 100;

/// Largest number of unknown columns that are kept in a record.
constexpr std::size_t kMostExtra = 16;

/// 64 MiB. With two characters per number, such a file needs a gigabyte of memory when it is read.
constexpr std::uintmax_t kLargest = std::uintmax_t{64} << 20U;
constexpr std::size_t kMostOpened = kLargest / 2;

void refuse_huge(const std::string& path) {
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  if (!unknown && size > kLargest && !is_container(path))
    throw Failure(ExitCode::bad_input, fmt::format("{}: {} MiB exceeds the limit of {} MiB; cut the log", path,
                                                   size >> 20U, kLargest >> 20U));
}

void refuse_huge(const Log& log) {
  std::size_t numbers = 0;
  for (const LogColumn& column : log.columns) numbers += column.values.size();
  if (numbers > kMostOpened)
    throw Failure(ExitCode::bad_input, fmt::format("{}: {} numbers exceed the limit of {}; cut the log, or keep fewer "
                                                   "channels of it",
                                                   log.path, numbers, kMostOpened));
}

bool same_channels(const Log& a, const Log& b) {
  return std::ranges::equal(a.columns, b.columns, {}, &LogColumn::name, &LogColumn::name) &&
         std::ranges::equal(a.columns, b.columns, {}, &LogColumn::unit, &LogColumn::unit);
}

/// "run 3" of "log.csv", axis x: "log-x-run3".
std::string record_name(const std::string& path, const std::string& axis, std::size_t run, bool several) {
  std::string name = std::filesystem::path(path).stem().string();
  if (several) return name_for_axis(name, axis, fmt::format("-run{}.csv", run + 1));
  return name_for_axis(name, axis, ".csv");
}

Log rows_of(const Log& log, std::size_t begin, std::size_t end) {
  Log part = log;
  if (part.first_line > 0) part.first_line += begin;
  for (LogColumn& column : part.columns) {
    const std::size_t last = std::min(end, column.values.size()), first = std::min(begin, last);
    column.values = {column.values.begin() + static_cast<std::ptrdiff_t>(first),
                     column.values.begin() + static_cast<std::ptrdiff_t>(last)};
  }
  return part;
}

bool has_gaps(const std::vector<double>& values) {
  return std::ranges::any_of(values, [](double value) { return std::isnan(value); });
}

/// Makes the records of one axis of a log.
class RecordMaker {
 public:
  RecordMaker(const Log& log, OpenedFile& file, std::string drive) : log_(log), file_(file), drive_(std::move(drive)) {}

  void make(const OpenedAxis& axis) {
    const std::vector<std::size_t>& starts = time_of(axis, file_.understood).run_starts;
    const bool several = !starts.empty();
    std::size_t begin = 0, runs = 0, short_runs = 0;
    for (std::size_t k = 0; k <= starts.size(); ++k) {
      const std::size_t end = k < starts.size() ? starts[k] : longest();
      if (several && end - begin < kFewestRowsOfARun)
        ++short_runs;
      else
        make_run(axis, several ? rows_of(log_, begin, end) : log_, runs++, several);
      begin = end;
    }
    if (short_runs > 0)
      lack(axis, fmt::format("{} runs of fewer than {} rows were left out", short_runs, kFewestRowsOfARun));
  }

 private:
  std::size_t longest() const {
    std::size_t rows = 0;
    for (const LogColumn& column : log_.columns) rows = std::max(rows, column.values.size());
    return rows;
  }

  void lack(const OpenedAxis& axis, const std::string& what) {
    file_.understood.missing.push_back(axis.name.empty() ? what : fmt::format("{}: {}", axis.name, what));
  }

  void make_run(const OpenedAxis& axis, const Log& log, std::size_t run, bool several) {
    const TimeBase& all = time_of(axis, file_.understood);
    const TimeBase time = several ? time_of_run(log, all) : all;
    if (time.source.empty()) return;
    ImportOptions options;
    options.drive = drive_;
    options.mappings.push_back({"t_s", time.source, {}, time.factor, 0.0});
    options.mappings.insert(options.mappings.end(), axis.mappings.begin(), axis.mappings.end());
    share_stamps(log, options.mappings);
    add_unknown(log, axis, options.mappings);
    options.unwrap = axis.unwrap;
    options.resample_period_s = time.resample_s;
    const bool uneven = std::ranges::any_of(options.mappings, [&](const Mapping& m) {
      return !m.time_source.empty() || (m.source != kRowSource && has_gaps(log.find(m.source).values));
    });
    if (uneven && !options.resample_period_s) options.resample_period_s = time.period_s;
    try {
      Record record = import_record(log, options);
      file_.records.push_back({record_name(file_.path, axis.name, run, several), axis.name, std::move(record)});
    } catch (const Failure& failure) {
      std::string what = failure.what();
      if (what.starts_with(log.path + ": ")) what.erase(0, log.path.size() + 2);
      lack(axis, what);
    }
  }

  static TimeBase time_of_run(const Log& log, const TimeBase& all) {
    for (const LogColumn& column : log.columns)
      if (column.name == all.source) {
        const ChannelName name = understand_name(column);
        TimeBase time = time_base_of(log, &column, &name, {});
        if (!name.unit) time.factor = all.factor;
        return time;
      }
    return all;
  }

  /// Replaces separate stamps by the log's stamps if they are equal.
  void share_stamps(const Log& log, std::vector<Mapping>& mappings) const {
    if (mappings.front().source == kRowSource) return;
    const std::vector<double>& stamps = log.find(mappings.front().source).values;
    for (Mapping& mapping : mappings)
      if (!mapping.time_source.empty() && log.find(mapping.time_source).values == stamps) mapping.time_source.clear();
  }

  /// Adds channels that were not recognised under their own names.
  void add_unknown(const Log& log, const OpenedAxis& axis, std::vector<Mapping>& mappings) const {
    if (file_.understood.axes.size() > 1) return;
    std::size_t added = 0;
    for (std::size_t k = 0; k < log.columns.size() && added < kMostExtra; ++k) {
      const LogColumn& column = log.columns[k];
      const OpenedChannel& channel = file_.understood.channels[k];
      std::string name = column.name;
      for (char& c : name)
        if (c == ',' || c == '#' || c == '"' || c == '\n' || c == '\r') c = '_';
      const bool taken = !channel.taken_as.empty() || name.empty() || find_known_column(name) != nullptr ||
                         name == kRowSource ||
                         std::ranges::any_of(mappings, [&](const Mapping& m) { return m.column == name; });
      const bool whole = column.fault.empty() && column.values.size() == log.columns.front().values.size() &&
                         std::ranges::all_of(column.values, [](double value) { return std::isfinite(value); });
      if (taken || !whole || !(column.time.empty() || column.time == axis.stamps)) continue;
      if (&log.find(column.name) != &column) continue;  // the name occurs twice
      mappings.push_back({name, column.name, {}, 1.0, 0.0});
      ++added;
    }
  }

  const Log& log_;
  OpenedFile& file_;
  std::string drive_;
};

/// Applies the user's mappings instead of the recognised ones.
void override_by(const std::vector<Mapping>& mappings, const Log& log, Understanding& understood) {
  if (mappings.empty()) return;
  if (understood.axes.empty()) understood.axes.emplace_back();
  for (const Mapping& mapping : mappings) {
    if (mapping.column == "t_s") {
      understood.time.source = mapping.source;
      understood.time.factor = mapping.factor;
      understood.time.why = "as given";
      for (OpenedAxis& axis : understood.axes) axis.own_time.reset();
      understood.time.sure = 1.0;
      if (mapping.source == kRowSource) understood.time.period_s = mapping.factor;
      if (mapping.source == kRowSource) understood.time.resample_s.reset();
      continue;
    }
    const LogColumn& source = log.find(mapping.source);
    const auto at = static_cast<std::size_t>(&source - log.columns.data());
    OpenedAxis* axis = &understood.axes.front();
    for (OpenedAxis& candidate : understood.axes)
      if (candidate.name == understood.channels[at].axis) axis = &candidate;
    std::erase_if(axis->mappings,
                  [&](const Mapping& m) { return m.column == mapping.column || log.columns[at].name == m.source; });
    axis->mappings.push_back(mapping);
    OpenedChannel& channel = understood.channels[at];
    for (OpenedChannel& other : understood.channels)
      if (other.taken_as == mapping.column && other.axis == channel.axis) other.taken_as.clear();
    channel.taken_as = mapping.column;
    channel.factor = mapping.factor;
    channel.offset = mapping.shift;
    channel.why = "as given";
    channel.sure = 1.0;
    std::erase_if(understood.asks,
                  [&](const std::string& ask) { return ask.find("'" + channel.name + "'") != std::string::npos; });
    std::erase_if(understood.missing,
                  [&](const std::string& text) { return text.find("'" + channel.name + "'") != std::string::npos; });
  }
  for (OpenedAxis& axis : understood.axes) {
    const auto has = [&](std::initializer_list<std::string_view> names) {
      return std::ranges::any_of(axis.mappings, [&](const Mapping& m) {
        return std::ranges::find(names, std::string_view(m.column)) != names.end();
      });
    };
    const bool effort = has({"i_A", "u_V"});
    if (effort)
      std::erase_if(understood.missing,
                    [](const std::string& text) { return text.find("the effort:") != std::string::npos; });
    axis.makes_record =
        effort && has({"x_mm", "x_m", "w_rad_s", "v_mm_s", "v_m_s"}) && !time_of(axis, understood).source.empty();
  }
}

void open_by_mapping(const Log& log, const std::vector<MappedAxis>& axes, OpenedFile& file) {
  for (const LogColumn& column : log.columns)
    file.understood.channels.push_back({column.name, {}, {}, 1.0, 0.0, "not in the mapping", 1.0});
  for (const MappedAxis& axis : axes) {
    ImportOptions options;
    options.mappings = parse_mappings(axis.map);
    options.resample_period_s = axis.resample_s;
    for (const std::string& text : axis.unwrap) options.unwrap.push_back(parse_unwrapping(text));
    for (const Mapping& mapping : options.mappings) {
      if (mapping.source == kRowSource) continue;
      const auto at = static_cast<std::size_t>(&log.find(mapping.source) - log.columns.data());
      OpenedChannel& channel = file.understood.channels[at];
      channel = {log.columns[at].name,  axis.name, mapping.column, mapping.factor, mapping.shift,
                 "by the mapping file", 1.0};
    }
    Record record = import_record(log, options);
    file.understood.rate_Hz = 1.0 / record.sample_period_s;
    file.records.push_back({record_name(file.path, axis.name, 0, false), axis.name, std::move(record)});
  }
}

}  // namespace

std::string name_for_axis(std::string_view stem, std::string_view axis, std::string_view ending) {
  std::string name = fmt::format("{}{}{}{}", stem, axis.empty() ? "" : "-", axis, ending);
  for (char& c : name)
    if (static_cast<unsigned char>(c) <= ' ' || c == '/' || c == '\\') c = '_';
  return name;
}

std::vector<std::string> Opening::asks() const {
  std::vector<std::string> all;
  for (const OpenedFile& file : files)
    for (const std::string& ask : file.understood.asks)
      if (std::ranges::find(all, ask) == all.end()) all.push_back(ask);
  return all;
}

std::vector<const OpenedRecord*> Opening::records() const {
  std::vector<const OpenedRecord*> all;
  for (const OpenedFile& file : files)
    for (const OpenedRecord& record : file.records) all.push_back(&record);
  return all;
}

void take_map(OpeningOptions& options, const std::string& map) {
  if (map.empty()) return;
  if (std::filesystem::exists(map))
    options.mapping_path = map;
  else
    take_mappings(options, map);
}

void take_mappings(OpeningOptions& options, const std::string& map) { options.hints.mappings = parse_mappings(map); }

Opening open_logs(const std::vector<std::string>& paths, const OpeningOptions& options) {
  std::vector<Log> logs;
  for (const std::string& path : paths) {
    refuse_huge(path);
    logs.push_back(read_log(path));
    refuse_huge(logs.back());
    if (!options.hal_path.empty()) name_by_hal(logs.back(), options.hal_path);
    decode_signs(logs.back());
  }
  std::vector<MappedAxis> mapped;
  if (!options.mapping_path.empty()) mapped = parse_mapping_file(read_file(options.mapping_path), options.mapping_path);
  Opening opening;
  for (const Log& log : logs) {
    OpenedFile file;
    file.path = log.path;
    file.understood.layout = log.layout;
    if (!mapped.empty()) {
      open_by_mapping(log, mapped, file);
      opening.files.push_back(std::move(file));
      continue;
    }
    constexpr std::size_t kMostSiblings = 8;
    std::vector<const Log*> group{&log};
    for (const Log& other : logs)
      if (&other != &log && group.size() < kMostSiblings && same_channels(other, log)) group.push_back(&other);
    file.understood = understand(log, group, options.hints);
    override_by(options.hints.mappings, log, file.understood);
    RecordMaker maker(log, file, options.hints.drive);
    for (const OpenedAxis& axis : std::vector<OpenedAxis>(file.understood.axes))
      if (axis.makes_record) maker.make(axis);
    opening.files.push_back(std::move(file));
  }
  return opening;
}

namespace {

/// Data-sheet values from the log, for each axis with a record.
nlohmann::json constants_json(const Understanding& understood) {
  nlohmann::json all = nlohmann::json::array();
  for (const OpenedAxis& axis : understood.axes) {
    if (!axis.makes_record) continue;
    nlohmann::json one = {{"axis", axis.name}};
    const auto put = [&one](const char* key, const std::optional<double>& value) {
      if (value) one[key] = *value;
    };
    put("encoder_step_mm", axis.constants.encoder_step_mm);
    put("current_noise_A", axis.constants.current_noise_A);
    put("amplifier_gain_A_per_V", axis.constants.amplifier_gain_A_per_V);
    put("resistance_Ohm", axis.constants.resistance_Ohm);
    put(axis.constants.is_linear ? "back_emf_V_s_per_m" : "back_emf_V_s_per_rad", axis.constants.back_emf_V_s);
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace

nlohmann::json to_json(const Opening& opening, const std::vector<std::string>& records) {
  nlohmann::json files = nlohmann::json::array();
  for (const OpenedFile& file : opening.files) {
    nlohmann::json channels = nlohmann::json::array();
    for (const OpenedChannel& channel : file.understood.channels)
      channels.push_back({{"name", channel.name},
                          {"axis", channel.axis},
                          {"taken_as", channel.taken_as},
                          {"factor", channel.factor},
                          {"offset", channel.offset},
                          {"why", channel.why},
                          {"sure", channel.sure}});
    files.push_back({{"file", file.path},
                     {"layout", file.understood.layout},
                     {"rate_Hz", file.understood.rate_Hz},
                     {"channels", std::move(channels)},
                     {"missing", file.understood.missing},
                     {"constants", constants_json(file.understood)},
                     {"next", next_run(file.understood)}});
  }
  return {{"format", "axis-opening/1"}, {"files", std::move(files)}, {"records", records}, {"asks", opening.asks()}};
}

std::string format_mapping(const Opening& opening) {
  std::vector<MappedAxis> axes;
  std::set<std::string> seen;
  for (const OpenedFile& file : opening.files)
    for (const OpenedAxis& axis : file.understood.axes) {
      if (!axis.makes_record || !seen.insert(axis.name).second) continue;
      const TimeBase& time = time_of(axis, file.understood);
      MappedAxis mapped;
      mapped.name = axis.name;
      mapped.map = mapping_text({"t_s", time.source, {}, time.factor, 0.0});
      for (const Mapping& mapping : axis.mappings) mapped.map += fmt::format(",{}", mapping_text(mapping));
      mapped.resample_s = time.resample_s;
      for (const Unwrapping& unwrap : axis.unwrap)
        mapped.unwrap.push_back(fmt::format("{}={}", unwrap.column, unwrap.range));
      axes.push_back(std::move(mapped));
    }
  return axes.empty() ? "" : format_mapping_file(axes);
}

std::vector<std::string> write_opening(const Opening& opening, const std::string& folder) {
  std::vector<std::string> written;
  std::filesystem::create_directories(folder);
  for (const OpenedRecord* record : opening.records()) {
    written.push_back((std::filesystem::path(folder) / record->name).string());
    write_record(record->record, written.back());
  }
  const std::string mapping = format_mapping(opening);
  if (!mapping.empty()) write_file_atomically((std::filesystem::path(folder) / "mapping.toml").string(), mapping);
  return written;
}

}  // namespace host
