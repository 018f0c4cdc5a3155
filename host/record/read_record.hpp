// Reads and writes measurements (`axis-record/1`, CSV). Every fault of a file is reported; nothing is repaired
// silently.
#pragma once

#include <string>
#include <string_view>

#include "host/record/record.hpp"

namespace host {

/// Smallest number of rows of a record. Identification has four unknowns, and a meaningful residual needs at least five
/// rows for each.
inline constexpr std::size_t kFewestRows = 20;

/// Reads and checks a record. The kind of drive follows from the speed column. A record with only a position is
/// presumed rotary if it is in mm and linear if it is in m, until adapt_to() knows the drive. Throws Failure(bad_input)
/// with file, line, column and remedy.
Record read_record(const std::string& path);

/// The same from text that is already in memory; `name` stands for the path in messages.
Record parse_record(std::string_view text, std::string_view name);

/// Writes a record in the units of the drive to a temporary file beside its destination, calls fsync and renames it.
/// Reading it again gives exactly the same numbers. Throws Failure(bad_input) if it cannot.
void write_record(const Record& record, const std::string& path);

/// The text that write_record() writes.
std::string format_record(const Record& record);

}  // namespace host
