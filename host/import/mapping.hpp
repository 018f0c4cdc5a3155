// `--map t_s=t,x_mm=counts*0.00122+0`: how the channels of a foreign log become the columns of a record.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace host {

/// One column of the record: column = factor * source + shift.
struct Mapping {
  std::string column;       ///< name in the record, with its unit
  std::string source;       ///< variable or column of the log; "3" and "#3" mean its third column
  std::string time_source;  ///< variable that holds the source's own time stamps (`x_m=pos@t_pos`); empty: that of t_s
  double factor = 1.0;
  double shift = 0.0;

  double apply(double value) const { return factor * value + shift; }
};

/// Parses a comma-separated list of `column=expression`. An expression is linear in one source. It holds numbers and
/// + - * /, but no parentheses. A name with blanks or operators stands in quotes: `u_V="Command (V)"`. Without a name,
/// a whole number in front is the number of a column: `x_mm=3*0.00122`.
/// Throws Failure(usage) naming the expression, the place in it and what would be right.
std::vector<Mapping> parse_mappings(std::string_view text);

}  // namespace host
