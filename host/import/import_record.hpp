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

/// A column that wraps at `range`, in its own unit: a counter that overflows, or an angle within a turn.
struct Unwrapping {
  std::string column;
  double range = 0.0;
};

/// Parses COLUMN=RANGE. Throws Failure(usage).
Unwrapping parse_unwrapping(std::string_view text);

struct ImportOptions {
  std::vector<Mapping> mappings;            ///< empty: every column keeps its name
  std::optional<double> resample_period_s;  ///< resample evenly with this period, and note it in the header
  std::string drive;                        ///< name of the drive; if empty, that of the log, if any
  std::vector<Unwrapping> unwrap{};
};

/// Name of a source that is the row number from 0, for logs without time stamps: `t_s=row*0.001`.
inline constexpr std::string_view kRowSource = "row";

/// Makes a record of a log, with the checks of read_record(). The header states the source of each column and, after
/// resampling, the jitter, the gaps and the interpolation. Throws Failure(bad_input) if variables are missing, lengths
/// differ, values are not numbers, samples are uneven (with the jitter and --resample in the message), a column to be
/// unwrapped leaves its range, or the record would not pass its checks.
Record import_record(const Log& log, const ImportOptions& options);

}  // namespace host
