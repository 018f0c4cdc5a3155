#include "host/import/log_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "host/exit_codes.hpp"
#include "host/nearest_name.hpp"
#include "host/read_file.hpp"
#include "host/record/text_encoding.hpp"

namespace host {

namespace {

/// Number of a column, from 1; 0 if the name is not a number.
std::size_t column_number(std::string_view name) {
  if (name.starts_with('#')) name.remove_prefix(1);
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc{} && end == name.data() + name.size() ? number : 0;
}

/// Converts `log(:,2)`, as MATLAB writes it, to `log(2)`.
std::string without_colon(std::string_view name) {
  std::string plain;
  for (const char c : name)
    if (c != ':' && c != ',' && c != ' ') plain += c;
  return plain;
}

constexpr std::string_view kSqliteMagic = "SQLite format 3", kHdf5Magic = "\x89HDF";

/// The first bytes of a file; empty for a pipe, whose bytes can be read only once.
std::string start_of(const std::string& path) {
  std::string start(16, '\0');
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return {};
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return start;
}

/// Rejects files that no library of Debian reads, and archives.
void refuse_unread(std::string_view start, const std::string& path) {
  struct Unread {
    std::string_view magic, what;
  };
  static constexpr Unread kUnread[] = {
      {"PAR1",
       "a Parquet file, which is not read; convert it to CSV: python3 -c \"import pandas; "
       "pandas.read_parquet('log.parquet').to_csv('log.csv', index=False)\""},
      {"#ROSBAG V", "a bag of ROS 1, which is not read; convert it: rosbags-convert --src log.bag --dst log"},
      {"\x28\xB5\x2F\xFD", "packed by zstd; unpack it: unzstd FILE"},
      {"\x1F\x8B", "packed by gzip; unpack it: gunzip FILE"}};
  for (const Unread& unread : kUnread)
    if (start.starts_with(unread.magic)) throw Failure(ExitCode::bad_input, fmt::format("{}: {}", path, unread.what));
}

}  // namespace

const LogColumn& Log::find(std::string_view name) const {
  for (const LogColumn& column : columns)
    if (!column.name.empty() && (column.name == name || (name.ends_with(')') && column.name == without_colon(name))))
      return column;
  const std::size_t number = column_number(name);
  if (number >= 1 && number <= columns.size()) return columns[number - 1];
  std::vector<std::string_view> names;
  for (const LogColumn& column : columns) names.push_back(column.name);
  throw Failure(ExitCode::bad_input, fmt::format("{}: there is no variable or column '{}'{}; there is {}", path, name,
                                                 did_you_mean(name, names), inventory()));
}

std::string Log::inventory() const {
  constexpr std::size_t kListed = 60;
  std::string text;
  for (std::size_t k = 0; k < std::min(columns.size(), kListed); ++k)
    text += fmt::format("{}{} ({})", k == 0 ? "" : ", ",
                        columns[k].name.empty() ? fmt::format("#{}", k + 1) : columns[k].name, columns[k].kind);
  if (columns.size() > kListed) text += fmt::format(" and {} more", columns.size() - kListed);
  return text.empty() ? "nothing" : text;
}

bool is_container(const std::string& path) {
  const std::string start = start_of(path);
  return start.starts_with(kSqliteMagic) || start.starts_with(kHdf5Magic) || start.starts_with(kMcapMagic);
}

Log read_log(const std::string& path) {
  const std::string start = start_of(path), extension = std::filesystem::path(path).extension();
  if (start.starts_with("MATLAB ") || (!start.empty() && extension == ".mat")) return read_mat(path);
  if (start.starts_with(kHdf5Magic) || (!start.empty() && (extension == ".h5" || extension == ".hdf5")))
    return read_hdf5(path);
  if (start.starts_with(kSqliteMagic)) return read_rosbag(path);
  refuse_unread(start, path);
  return parse_log(read_file(path, kLogSize), path);
}

Log parse_log(std::string_view bytes, std::string_view name) {
  if (bytes.starts_with(kMcapMagic)) return parse_mcap(bytes, name);
  if (bytes.starts_with("\x93NUMPY")) return parse_npy(bytes, name);
  if (bytes.starts_with("PK\x03\x04")) return parse_npz(bytes, name);
  return parse_log_text(bytes, name);
}

Log parse_log_text(std::string_view text, std::string_view name) {
  const std::string plain = as_utf8(std::string(text));
  for (const auto parse : {parse_sinumerik, parse_camonitor, parse_channel_blocks})
    if (std::optional<Log> log = parse(plain, name)) return std::move(*log);
  return parse_table(plain, name);
}

}  // namespace host
