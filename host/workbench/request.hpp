// Requests of the page, as JSON, and the equivalent command.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "host/compare/focus.hpp"

namespace host::workbench {

enum class Task { compare, identify, diagnose, add, adjust, improve };

std::string_view task_name(Task task);

/// A task on files of the folder: { "do": "add", "model": "x.toml", "kind": "cogging", "train": [...], "validate":
/// [...], "accept": [...] }; compare has "models" and "records", the model of identify is a data sheet.
struct Request {
  Task task = Task::compare;
  std::vector<std::string> models;  ///< one, but for compare
  std::vector<std::string> train;   ///< all records of a comparison
  std::vector<std::string> validate, accepted, absent;
  std::string kind, over;           ///< of add
  std::vector<std::string> values;  ///< of adjust: "NAME=VALUE"
  bool quick = false;               ///< of diagnose
  Focus focus;                      ///< of compare: "traces", "stretch": [FROM, TO], "period_mm", "map": [ACROSS, UP]
};

inline constexpr std::size_t kLongestRequest = 65'536;

/// Throws Failure(usage) naming the field and what belongs there; names are plain (is_plain_name), the files may be
/// missing.
Request parse_request(std::string_view text);

/// { "record": NAME, "stretch": [FROM, TO] }: the time range to remove from a record.
struct CutRequest {
  std::string record;
  TimeSpan stretch;
};
CutRequest parse_cut(std::string_view text);

/// { "logs": [NAME...], "yes": whether to accept what is not sure }; logs of one controller help each other.
struct OpenRequest {
  std::vector<std::string> logs;
  bool yes = false;
};
OpenRequest parse_open(std::string_view text);

/// The selection on the page: { "model": NAME, "beside": [NAME...], "roles": { NAME: "train"|"judge"|"off" } }. Returns
/// the same, checked.
nlohmann::json parse_choice(std::string_view text);

nlohmann::json to_json(const Request& request);

/// Files for the results. Empty names are left out.
struct Outputs {
  std::string model, json, report;
};

/// To paste into a shell in the folder.
std::string command_line(const Request& request, const Outputs& outputs);

}  // namespace host::workbench
