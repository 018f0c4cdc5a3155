// Layout of the lines of a table (separator, decimal sign, number of fields), determined from the lines.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace host {

struct TableLayout {
  char separator = 0;  ///< 0: any sequence of blanks
  bool decimal_comma = false;
  std::size_t fields = 0;  ///< number of fields in most lines

  /// The fields of a line, without surrounding blanks and double quotes. A separator inside quotes does not separate.
  void split(std::string_view line, std::vector<std::string_view>& fields) const;
  std::optional<double> number(std::string_view field) const;
  double last_digit(std::string_view field) const;
  std::string_view separator_name() const;
};

/// The layout for which most lines have the same number of fields and most fields are numbers or times.
TableLayout find_layout(std::string_view text);

/// Whether a line is a remark before a table.
bool is_remark(std::string_view line);

/// Removes the next line from `rest` and returns it without its line end; false if there is none.
bool take_line(std::string_view& rest, std::string_view& line);

}  // namespace host
