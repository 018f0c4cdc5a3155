// `--map t_s=t,x_mm=counts*0.00122+0`: conversion of the channels of a foreign log to the columns of a record.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace host {

/// One column of the record: column = factor * source + shift.
struct Mapping {
  std::string column;       ///< name in the record, with its unit
  std::string source;       ///< variable or column of the log; "3" and "#3" mean its third column
  std::string time_source;  ///< variable with the source's own time stamps (`x_m=pos@t_pos`); empty: that of t_s
  double factor = 1.0;
  double shift = 0.0;

  double apply(double value) const { return factor * value + shift; }
};

/// Parses a comma-separated list of `column=expression`. An expression is linear in one source, with numbers and + - *
/// /, but no parentheses. A name with blanks or operators is in quotes: `u_V="Command (V)"`. If there is no name, a
/// whole number at the start is the number of a column: `x_mm=3*0.00122`. Throws Failure(usage) with the expression,
/// the place of the error and a correction.
std::vector<Mapping> parse_mappings(std::string_view text);

}  // namespace host
