// Edits that messages about records recommend: cutting out a part, or shifting a channel in time. The header of the
// record notes the edit.
#pragma once

#include <string>
#include <string_view>

#include "host/record/record.hpp"

namespace host {

/// The rows from `from_s` to `to_s`, both included, with unchanged time stamps. Only the remaining rows must form a
/// valid record. `text` is the content of the file, `name` stands for its path in messages. Throws Failure(usage) if no
/// row remains, and as parse_record() does.
Record cut_record(std::string_view text, const std::string& name, double from_s, double to_s);

/// Shifts the channel `name` by `by_s` to later times (negative: earlier). The value of row k becomes that at t - by_s,
/// interpolated linearly; for u_V, which is held, the mean over the period. Rows at the ends without a recorded value
/// are removed. Throws Failure(usage) if the channel is missing or contains text, or if too few rows remain.
Record shift_channel(const Record& record, std::string_view name, double by_s);

}  // namespace host
