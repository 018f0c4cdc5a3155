// Somebody else's log as it lies in a file: named or numbered columns, of whatever length.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace host {

struct LogColumn {
  std::string name;  ///< variable in a .mat file (`log(2)`, `s.speed`), heading in a table, "" without heading
  std::string kind;  ///< what it is, for messages: "double, 24841 x 1"
  std::vector<double> values;  ///< NaN where the field is empty
  std::string fault;           ///< why the values cannot be used, or stop early; empty: they are good
  double last_digit = 0.0;     ///< weight of the finest digit in the text; 0: binary numbers
};

struct Log {
  std::string path;
  std::vector<LogColumn> columns;
  std::map<std::string, std::string> header;  ///< `# key: value` lines of a table
  std::size_t first_line = 0;                 ///< line of row 0 in a table; 0: not a table

  /// By name, else by number ("3", "#3", from 1). Throws Failure(bad_input) that lists what there is.
  const LogColumn& find(std::string_view name) const;

  /// "t (double, 24841 x 1), qm (…)".
  std::string inventory() const;
};

/// Reads a MATLAB file (v4, v5, v7.3: by its content), a NumPy array (.npy) or a table: fields separated by comma,
/// semicolon, tab or blanks, numbers with decimal point or comma (found out), with or without headings, a second line
/// of units, remarks (# or %) or a preamble in front; UTF-8 or UTF-16. Dates and times of day become seconds. Throws
/// Failure(bad_input).
Log read_log(const std::string& path);

/// read_log of a table that is already in memory.
Log parse_table(std::string_view text, std::string_view name);

/// read_log of a NumPy array.
Log parse_npy(std::string_view bytes, std::string_view path);

/// read_log of a MATLAB file.
Log read_mat(const std::string& path);

}  // namespace host
