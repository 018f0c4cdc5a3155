// Measurements in (`axis-record/1`, CSV). Every fault of a file is reported; nothing is repaired silently.
#pragma once

#include <string>
#include <string_view>

#include "host/record/record.hpp"

namespace host {

/// Fewest rows of a record: identification has four unknowns, and a meaningful residual needs at least five rows for
/// each.
inline constexpr std::size_t kFewestRows = 20;

/// Reads and checks a record. The kind of drive follows from the speed column; a record with only a position is
/// presumed rotary if it is in mm and linear if in m, until adapt_to() knows its drive. Throws Failure(bad_input)
/// naming file, line, column and remedy.
Record read_record(const std::string& path);

/// The same from text that is already in memory; `name` stands for the path in messages.
Record parse_record(std::string_view text, std::string_view name);

/// Writes a record in the drive's own units beside its destination, fsyncs, renames. Reading it again gives the same
/// numbers to the last bit. Throws Failure(bad_input) when it cannot.
void write_record(const Record& record, const std::string& path);

/// The text of write_record.
std::string format_record(const Record& record);

}  // namespace host
