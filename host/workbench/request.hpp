// Requests of the page, as JSON, and the equivalent command.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/compare/focus.hpp"
#include "host/workbench/commission_request.hpp"
#include "host/workbench/request_fields.hpp"

namespace host::workbench {

enum class Task { compare, identify, diagnose, add, adjust, improve, commission };

std::string_view task_name(Task task);

/// A task on files of the folder: { "do": "add", "model": "x.toml", "kind": "cogging", "train": [...], "validate":
/// [...], "accept": [...] }. compare has "models" and "records" instead; the model of identify is a data sheet.
/// commission: CommissionRequest.
struct Request {
  Task task = Task::compare;
  std::vector<std::string> models;  ///< one; for compare, one or more
  std::vector<std::string> train;   ///< all records of a comparison
  std::vector<std::string> validate, accepted, absent;
  std::string kind, over;           ///< for add
  std::vector<std::string> values;  ///< for adjust: "NAME=VALUE"
  bool quick = false;               ///< for diagnose
  std::string like;                 ///< for compare: coordinate over which to look for effects of that shape
  Focus focus;                      ///< for compare: "traces", "stretch": [FROM, TO], "period_mm", "map": [ACROSS, UP],
                                    ///< "plot": [X, Y]
  std::optional<CommissionRequest> commission;  ///< for commission, whose only other fields are the task and one model
};

/// Throws Failure(usage) naming the field and its expected value. Names are plain (is_plain_name); the files may be
/// missing.
Request parse_request(std::string_view text);

/// { "record": NAME, "stretch": [FROM, TO], "keep": whether to keep only it }: the time range to remove from a record,
/// or to keep as a record of its own.
struct CutRequest {
  std::string record;
  TimeSpan stretch;
  bool keep = false;
};
CutRequest parse_cut(std::string_view text);

/// { "logs": [NAME...], "yes": whether to accept uncertain channels }. Logs of one controller are opened together,
/// because one helps to recognise the channels of another.
struct OpenRequest {
  std::vector<std::string> logs;
  bool yes = false;
  std::vector<std::string> map{};  ///< "x_mm=pos*0.001": the channels that the user has chosen
};
OpenRequest parse_open(std::string_view text);

/// The selection on the page: { "model": NAME, "beside": [NAME...], "roles": { NAME: "train"|"judge"|"off" } }. Returns
/// the checked selection.
nlohmann::json parse_choice(std::string_view text);

nlohmann::json to_json(const Request& request);

/// Files for the results; an empty name: no file.
struct Outputs {
  std::string model, json, report;
};

/// The equivalent command, to paste into a shell in the folder.
std::string command_line(const Request& request, const Outputs& outputs);

}  // namespace host::workbench
