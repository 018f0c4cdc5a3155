// Makes records from any controller's logs: recognised channels, and missing information.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/opening/understanding.hpp"
#include "host/record/record.hpp"

namespace host {

struct OpeningOptions {
  OpeningHints hints;
  std::string hal_path{};      ///< names of a halsampler log; empty: none
  std::string mapping_path{};  ///< an accepted mapping (axis-mapping/1); empty: none
};

/// `map`: the file of an accepted mapping, or an argument of --map: `x_mm=pos*0.001,…`. Throws Failure(usage).
void take_map(OpeningOptions& options, const std::string& map);

/// The name of a file of one axis, "model-x.toml"; characters of the axis' name cannot lead to another folder.
std::string name_for_axis(std::string_view stem, std::string_view axis, std::string_view ending);

struct OpenedRecord {
  std::string name;  ///< of its file, "log-x.csv"
  std::string axis;
  Record record;
};

struct OpenedFile {
  std::string path;
  Understanding understood;
  std::vector<OpenedRecord> records;  ///< that can be made of it once all questions are answered
};

struct Opening {
  std::vector<OpenedFile> files;

  /// For all files, each once.
  std::vector<std::string> asks() const;
  std::vector<const OpenedRecord*> records() const;
};

/// Reads and understands. Throws Failure(bad_input) where a file cannot be read at all.
Opening open_logs(const std::vector<std::string>& paths, const OpeningOptions& options);

/// Writes the records and the accepted mapping (mapping.toml) into a folder, which is made if missing; returns the
/// records' files. Throws Failure as write_record() does.
std::vector<std::string> write_opening(const Opening& opening, const std::string& folder);

/// `axis-opening/1`. `records` are the files that were written.
nlohmann::json to_json(const Opening& opening, const std::vector<std::string>& records);

/// The mapping of all axes as a file that open_logs() takes for the next log of that machine.
std::string format_mapping(const Opening& opening);

}  // namespace host
