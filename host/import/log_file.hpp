// A foreign log as read from a file: columns of any length with names or numbers.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace host {

struct LogColumn {
  std::string name;            ///< variable in a .mat file (`log(2)`, `s.speed`) or heading in a table; may be empty
  std::string kind;            ///< type and size, for messages: "double, 24841 x 1"
  std::vector<double> values;  ///< NaN for an empty field
  std::string fault;           ///< why the values cannot be used, or end early; empty if there is no fault
  double last_digit = 0.0;     ///< weight of the finest digit in the text; 0 for binary numbers
  std::string unit{};          ///< from the file, separate from the name: a line of units, a header; may be empty
  std::string time{};          ///< column with its own time stamps; empty if it has those of the log
};

/// Limits of a preamble: number of lines, and bytes per line; more than any known logger writes (TwinCAT: 24).
inline constexpr std::size_t kMostPreamble = 100, kLongestPreamble = 400;

struct Log {
  std::string path;
  std::vector<LogColumn> columns;
  std::map<std::string, std::string> header;  ///< `# key: value` lines of a table
  std::size_t first_line = 0;                 ///< line of row 0 in a table; 0 for other files
  std::string layout = "table";               ///< kind of file: "twincat-scope", "camonitor", "mat", …
  std::vector<std::string> preamble{};        ///< the lines before the table, including remarks; at most kMostPreamble

  /// The column with that name or number ("3", "#3", from 1). Throws Failure(bad_input) with the list of columns.
  const LogColumn& find(std::string_view name) const;

  /// "t (double, 24841 x 1), qm (…)".
  std::string inventory() const;
};

/// Reads a MATLAB file (v4, v5, v7.3; recognised by its content), an HDF5 file, joint states of a ROS 2 bag (SQLite or
/// MCAP), a NumPy array (.npy, .npz) or a table. A table has fields separated by comma, semicolon, tab or blanks, and
/// numbers with decimal point or comma (detected). It may have headings, further lines of headings or units, and
/// remarks (# or %) or a preamble before it, in UTF-8, UTF-16 or Windows-1252. Dates and times of day become seconds.
/// Also recognised by their content are exports of TwinCAT Scope and of National Instruments' loggers (a header for
/// each channel, separate time columns), EPICS camonitor (a line per value) and SINUMERIK traces (XML). Throws
/// Failure(bad_input).
Log read_log(const std::string& path);

/// Whether the size of a file does not limit the memory, because it may contain other data (pictures in a bag) or
/// compressed numbers.
bool is_container(const std::string& path);

/// As read_log(), for a file in memory of a kind that needs no third-party library.
Log parse_log(std::string_view bytes, std::string_view name);

/// As read_log(), for text in memory in any of the text layouts.
Log parse_log_text(std::string_view text, std::string_view name);

/// As read_log(), for a table in memory.
Log parse_table(std::string_view text, std::string_view name);

/// A table with a header of several lines above the channels, and a time column before one or several channels (TwinCAT
/// 3 Scope, NI). Empty for any other text.
std::optional<Log> parse_channel_blocks(std::string_view text, std::string_view name);

/// One value per line: name, date, time, value (EPICS camonitor). Empty for any other text.
std::optional<Log> parse_camonitor(std::string_view text, std::string_view name);

/// The trace of a SINUMERIK control (XML: dataFrame, dataSignal, rec). Empty for any other text.
std::optional<Log> parse_sinumerik(std::string_view text, std::string_view name);

/// As read_log(), for a NumPy array.
Log parse_npy(std::string_view bytes, std::string_view path);

/// As read_log(), for an archive of NumPy arrays as numpy.savez writes it (not compressed).
Log parse_npz(std::string_view bytes, std::string_view path);

/// As read_log(), for an MCAP file.
Log parse_mcap(std::string_view bytes, std::string_view path);
inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

/// As read_log(), for files that third-party libraries read in a separate process (confined_reader.hpp).
Log read_mat(const std::string& path);
Log read_hdf5(const std::string& path);
Log read_rosbag(const std::string& path);

}  // namespace host
