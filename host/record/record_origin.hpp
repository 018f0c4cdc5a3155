// Where records came from, as messages and models name it.
#pragma once

#include <string>
#include <vector>

#include "host/record/record.hpp"

namespace host {

/// The record's file without its folders.
std::string file_name(const Record& record);

/// The files of all records, "jog.csv, sweep.csv": the origin that a model states.
std::string origin_of(const std::vector<Record>& records);

}  // namespace host
