// Records from other programs' logs.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/import/log_file.hpp"
#include "host/import/mapping.hpp"
#include "host/record/record.hpp"

namespace host {

/// A column that wraps at `range`, in its own unit: a counter that overflows, an angle within a turn.
struct Unwrapping {
  std::string column;
  double range = 0.0;
};

/// Parses COLUMN=RANGE. Throws Failure(usage).
Unwrapping parse_unwrapping(std::string_view text);

struct ImportOptions {
  std::vector<Mapping> mappings;            ///< empty: every column keeps its name
  std::optional<double> resample_period_s;  ///< resample evenly with this period, and state it
  std::string drive;                        ///< name of the drive; empty: the log's, if it has one
  std::vector<Unwrapping> unwrap{};
};

/// The row number of a log from 0, as if it were a column: for logs without time stamps, `t_s=row*0.001`.
inline constexpr std::string_view kRowSource = "row";

/// Makes a record of a log, with the checks of read_record(); the header says where each column came from and, after
/// resampling, the jitter, the gaps and how values were found between samples.
/// Throws Failure(bad_input) where variables are missing, lengths differ, values are no numbers, samples are uneven
/// (naming the jitter and --resample), a column to be unwrapped leaves its range, or the record would not pass its
/// checks.
Record import_record(const Log& log, const ImportOptions& options);

}  // namespace host
