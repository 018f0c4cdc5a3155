// Records as named columns of numbers, in memory, for programs that have them there.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "host/record/record.hpp"

namespace host {

struct RecordColumns {
  std::vector<std::pair<std::string, std::vector<double>>> columns;
  std::map<std::string, std::string> header;  ///< the lines "# key: value"; "format" may be absent
};

/// With the checks of read_record(), and the record that it would make of the same numbers in a file: stamps count as
/// exact to the digits that they need. `name` stands for the path in messages; rows count from 0. Throws
/// Failure(bad_input).
Record record_of(RecordColumns columns, const std::string& name);

/// What write_record() would write.
RecordColumns columns_of(const Record& record);

}  // namespace host
