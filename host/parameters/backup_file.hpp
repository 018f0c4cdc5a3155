// All parameters of a board in a file with a checksum.
#pragma once

#include <string>
#include <vector>

#include "host/parameters/parameter_file.hpp"

namespace host {

/// A file of parameters (`axis-params/1`), each with unit and meaning, headed by their count and the CRC-32 of all that
/// follows it. `foreign`: entries of a board's flash that the table does not have; they stand in comments.
std::string format_backup(const firmware::ParameterValues& values,
                          const std::vector<firmware::StoredEntry>& foreign = {});

/// Reads a backup. Throws Failure(bad_input) where count or CRC tell that it was cut or changed; where it has neither,
/// as those of older programs, unless it names every parameter to its last line's end.
std::vector<Assignment> read_backup(const std::string& path);
std::vector<Assignment> parse_backup(std::string_view text, std::string_view name);

}  // namespace host
