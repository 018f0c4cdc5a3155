// Edits that messages about records advise: cut a part, or shift a channel in time. The header records the edit.
#pragma once

#include <string>
#include <string_view>

#include "host/record/record.hpp"

namespace host {

/// The rows from `from_s` to `to_s`, both included; stamps stay as they are. Only the remaining rows must form a valid
/// record. `text` is the file's, `name` stands for its path in messages. Throws Failure(usage) where no row remains,
/// and as parse_record() does.
Record cut_record(std::string_view text, const std::string& name, double from_s, double to_s);

/// The channel `name` later by `by_s` (earlier where negative): row k holds what it held at t - by_s, found by straight
/// lines, of u_V by its mean over the period, since it is held. Rows at the ends for which nothing was recorded are cut
/// off. Throws Failure(usage) for a channel that is not there or holds texts, and where too few rows remain.
Record shift_channel(const Record& record, std::string_view name, double by_s);

}  // namespace host
