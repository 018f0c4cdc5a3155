// All parameters of a board in a file with a checksum.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/core/compensation/pitch_table.hpp"
#include "host/parameters/parameter_file.hpp"

namespace host {

using PitchTables = std::vector<std::vector<firmware::PitchPoint>>;  ///< one table for each axis

/// A file of parameters (`axis-params/1`), each with unit and meaning. The header contains their count and the CRC-32
/// of the text after it. `foreign`: entries in a board's flash that are unknown to the table. `pitch`: each axis's
/// table of pitch errors. Both are written as comments, so that the file remains a file of parameters.
std::string format_backup(const firmware::ParameterValues& values,
                          const std::vector<firmware::StoredEntry>& foreign = {}, const PitchTables& pitch = {});

/// Reads a backup. Throws Failure(bad_input) if count or CRC show that it was cut or changed. A backup of older
/// programs has neither; it must name every parameter and end with a complete line.
std::vector<Assignment> parse_backup(std::string_view text, std::string_view name);

/// The tables of a backup that parse_backup() accepts, one per axis; empty for programs that did not save them. Throws
/// Failure(bad_input) for a line that is not a point, or points that no board accepts.
std::optional<PitchTables> pitch_of_backup(std::string_view text, std::string_view name, std::size_t axes);

}  // namespace host
