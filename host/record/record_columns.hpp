// Records as named columns of numbers in memory, for other programs.
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

/// Makes the same record as read_record() from the same numbers in a file, with the same checks. Time stamps count as
/// exact to the digits that they need. `name` stands for the path in messages; rows count from 0. Throws
/// Failure(bad_input).
Record record_of(RecordColumns columns, const std::string& name);

/// The columns that write_record() would write.
RecordColumns columns_of(const Record& record);

}  // namespace host
