#include "host/record/record_origin.hpp"

#include <filesystem>

namespace host {

std::string file_name(const Record& record) { return std::filesystem::path(record.path).filename().string(); }

std::string origin_of(const std::vector<Record>& records) {
  std::string origin;
  for (const Record& record : records) origin += (origin.empty() ? "" : ", ") + record.path;
  return origin;
}

}  // namespace host
