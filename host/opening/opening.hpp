// Makes records from logs of any controller, and lists recognised channels and missing information.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/opening/understanding.hpp"
#include "host/record/record.hpp"

namespace host {

struct OpeningOptions {
  OpeningHints hints;
  std::string hal_path{};      ///< file with the names of a halsampler log; may be empty
  std::string mapping_path{};  ///< file with an accepted mapping (axis-mapping/1); may be empty
};

/// `map`: the file of an accepted mapping, or an argument of --map such as `x_mm=pos*0.001,…`. Throws Failure(usage).
void take_map(OpeningOptions& options, const std::string& map);

/// The same, but never a file.
void take_mappings(OpeningOptions& options, const std::string& map);

/// The file name for one axis, "model-x.toml". Characters in the axis name cannot lead to another folder.
std::string name_for_axis(std::string_view stem, std::string_view axis, std::string_view ending);

struct OpenedRecord {
  std::string name;  ///< name of its file, "log-x.csv"
  std::string axis;
  Record record;
};

struct OpenedFile {
  std::string path;
  Understanding understood;
  std::vector<OpenedRecord> records;  ///< records that can be made once all questions are answered
};

struct Opening {
  std::vector<OpenedFile> files;

  /// The questions for all files, each once.
  std::vector<std::string> asks() const;
  std::vector<const OpenedRecord*> records() const;
};

/// Reads the logs and determines their channels. Throws Failure(bad_input) if a file cannot be read at all.
Opening open_logs(const std::vector<std::string>& paths, const OpeningOptions& options);

/// Writes the records and the accepted mapping (mapping.toml) to a folder, which is created if necessary. Returns the
/// files of the records. Throws Failure as write_record() does.
std::vector<std::string> write_opening(const Opening& opening, const std::string& folder);

/// `axis-opening/1`. `records`: the files that were written.
nlohmann::json to_json(const Opening& opening, const std::vector<std::string>& records);

/// The mapping of all axes as a file for open_logs(), so that it can be used for the next log of the machine.
std::string format_mapping(const Opening& opening);

}  // namespace host
