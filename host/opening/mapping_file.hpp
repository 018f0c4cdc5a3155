// An accepted mapping as a file (`axis-mapping/1`, TOML), so that the next log of the machine needs no questions.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace host {

struct MappedAxis {
  std::string name;  ///< may be empty
  std::string map;   ///< in the language of --map, including t_s
  std::optional<double> resample_s;
  std::vector<std::string> unwrap;  ///< COLUMN=RANGE
};

std::string format_mapping_file(const std::vector<MappedAxis>& axes);

/// Throws Failure(bad_input) with file, line, field and remedy.
std::vector<MappedAxis> parse_mapping_file(std::string_view text, std::string_view name);

}  // namespace host
