// The page's actions, by the same functions as the commands: the same documents, digit for digit.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/workbench/folder.hpp"
#include "host/workbench/request.hpp"

namespace host {
struct ComparedModel;
}

namespace host::workbench {

struct Comparison {
  nlohmann::json document;  ///< of `axistool compare --json`
  std::string report;       ///< its page; empty where no effort was recorded
  std::string text;         ///< in place of the page
  std::string traces;       ///< record whose traces the page draws
};

/// The models that the request names, against its records. Throws as the command does.
std::vector<ComparedModel> compared_models(const Folder& folder, const Request& request);

/// Throws as the command does.
Comparison compare(const Folder& folder, const Request& request);

/// The comparison of the model with one that has other values, of a request to adjust: written to kTrial, nothing else.
/// Throws as the command does.
Comparison compare_trial(const Folder& folder, const Request& request);
inline constexpr const char* kTrial = "trial.toml";

/// Of a quick diagnosis: "document", its --json, and "report", its page. Throws as the command does.
nlohmann::json look_first(const Folder& folder, const Request& request);

/// The plot of an effect in the gallery, as report.js draws it, and how far it stands out. Throws Failure(usage) for an
/// unknown kind.
nlohmann::json gallery_picture(const std::string& kind);

/// Identifies, diagnoses, adds, adjusts or improves, writes the outputs, and returns the document of the command's
/// --json. Throws as the command does, and Cancelled.
nlohmann::json carry_out(const Folder& folder, const Request& request, const Outputs& outputs,
                         const std::function<void(double)>& progress);

/// Leaves a stretch out: what is before and after it as records of their own, by `axistool cut`; their names and the
/// commands. Pieces without enough rows are not written. Throws Failure(refused) where nothing is left.
nlohmann::json cut_out(const Folder& folder, const CutRequest& request);

/// Result of `axistool open` for logs: { "document": of its --json, "command" }. If no question is open, or uncertain
/// channels are accepted, the records are in their own folder.
nlohmann::json open_and_write(const Folder& folder, const OpenRequest& request);

}  // namespace host::workbench
