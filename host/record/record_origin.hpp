// The origin of records, as named in messages and models.
#pragma once

#include <string>
#include <vector>

#include "host/record/record.hpp"

namespace host {

/// The file name of the record, without folders.
std::string file_name(const Record& record);

/// The files of all records, "jog.csv, sweep.csv": the origin that a model names.
std::string origin_of(const std::vector<Record>& records);

}  // namespace host
