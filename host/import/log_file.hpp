// A foreign log as read from a file: named or numbered columns of any length.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace host {

struct LogColumn {
  std::string name;  ///< variable in a .mat file (`log(2)`, `s.speed`), heading in a table, "" without heading
  std::string kind;  ///< type and size, for messages: "double, 24841 x 1"
  std::vector<double> values;  ///< NaN where the field is empty
  std::string fault;           ///< why the values cannot be used, or end early; empty: no fault
  double last_digit = 0.0;     ///< weight of the finest digit in the text; 0: binary numbers
  std::string unit{};          ///< from the file, separate from the name: a line of units, a header; may be empty
  std::string time{};          ///< name of the column that holds its own time stamps; empty: the log's
};

/// Limits of a preamble: number of lines, and bytes of each line; more than any known logger writes (TwinCAT: 24).
inline constexpr std::size_t kMostPreamble = 100, kLongestPreamble = 400;

struct Log {
  std::string path;
  std::vector<LogColumn> columns;
  std::map<std::string, std::string> header;  ///< `# key: value` lines of a table
  std::size_t first_line = 0;                 ///< line of row 0 in a table; 0: not a table
  std::string layout = "table";               ///< what kind of file it is: "twincat-scope", "camonitor", "mat", …
  std::vector<std::string> preamble{};        ///< the lines before the table, including remarks; at most kMostPreamble

  /// By name, else by number ("3", "#3", from 1). Throws Failure(bad_input) listing the columns.
  const LogColumn& find(std::string_view name) const;

  /// "t (double, 24841 x 1), qm (…)".
  std::string inventory() const;
};

/// Reads a MATLAB file (v4, v5, v7.3: by its content), an HDF5 file, joint states of a ROS 2 bag (SQLite or MCAP), a
/// NumPy array (.npy, .npz) or a table: fields separated by comma, semicolon, tab or blanks, numbers with decimal point
/// or comma (found out), with or without headings, further lines of headings or units, remarks (# or %) or a preamble
/// in front; UTF-8, UTF-16 or Windows-1252. Dates and times of day become seconds. Exports of TwinCAT Scope and of
/// National Instruments' loggers (a header for each channel, time columns of their own), EPICS camonitor (a line for
/// each value) and SINUMERIK traces (XML) are known by their content. Throws Failure(bad_input).
Log read_log(const std::string& path);

/// Whether a file may contain much besides its numbers (pictures in a bag), or packs them, so that its size does not
/// limit the memory.
bool is_container(const std::string& path);

/// read_log of a file in memory, for the kinds that need no third-party library.
Log parse_log(std::string_view bytes, std::string_view name);

/// read_log of text in memory, in any of the text layouts.
Log parse_log_text(std::string_view text, std::string_view name);

/// read_log of a table in memory.
Log parse_table(std::string_view text, std::string_view name);

/// A table whose header stands above the channels, key by key, with a time column in front of one channel or of several
/// (TwinCAT 3 Scope, NI). Empty for any other text.
std::optional<Log> parse_channel_blocks(std::string_view text, std::string_view name);

/// One value a line: name, date, time, value (EPICS camonitor). Empty for any other text.
std::optional<Log> parse_camonitor(std::string_view text, std::string_view name);

/// The trace of a SINUMERIK control (XML: dataFrame, dataSignal, rec). Empty for any other text.
std::optional<Log> parse_sinumerik(std::string_view text, std::string_view name);

/// read_log of a NumPy array.
Log parse_npy(std::string_view bytes, std::string_view path);

/// read_log of an archive of NumPy arrays as numpy.savez writes it (not compressed).
Log parse_npz(std::string_view bytes, std::string_view path);

/// read_log of an MCAP file.
Log parse_mcap(std::string_view bytes, std::string_view path);
inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

/// read_log of files that third-party libraries read, in a separate process (confined_reader.hpp).
Log read_mat(const std::string& path);
Log read_hdf5(const std::string& path);
Log read_rosbag(const std::string& path);

}  // namespace host
