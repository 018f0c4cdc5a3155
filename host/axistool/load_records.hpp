// Records as commands read them: every file checked against the drive that it is said to come from.
#pragma once

#include <string>
#include <vector>

#include "host/record/channel_checks.hpp"
#include "host/record/read_record.hpp"

namespace axistool {

inline std::vector<host::Record> load_records(const std::vector<std::string>& paths, const sim::DataSheet& data) {
  std::vector<host::Record> records;
  for (const std::string& path : paths) {
    records.push_back(host::read_record(path));
    host::adapt_to(records.back(), data);
    host::check_units(records.back(), data);
  }
  return records;
}

}  // namespace axistool
