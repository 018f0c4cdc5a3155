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
  std::string report;       ///< its page; empty if no command, torque or force was recorded
  std::string text;         ///< instead of the page
  std::string traces;       ///< record whose traces the page draws
};

/// The models that the request names, against its records. Throws as the command does.
std::vector<ComparedModel> compared_models(const Folder& folder, const Request& request);

/// Throws as the command does.
Comparison compare(const Folder& folder, const Request& request);

/// Comparison of the model with one that has the values of a request to adjust, which is written to kTrial only. Throws
/// as the command does.
Comparison compare_trial(const Folder& folder, const Request& request);
inline constexpr const char* kTrial = "trial.toml";

/// Result of a quick diagnosis: "document", its --json, and "report", its page. Throws as the command does.
nlohmann::json look_first(const Folder& folder, const Request& request);

/// The plot of an effect in the gallery, for report.js, and the size of its residual relative to a run without it.
/// Throws Failure(usage) for an unknown kind.
nlohmann::json gallery_picture(const std::string& kind);

/// Identifies, diagnoses, adds, adjusts or improves, writes the outputs, and returns the document of the command's
/// --json. Throws as the command does, and Cancelled.
nlohmann::json carry_out(const Folder& folder, const Request& request, const Outputs& outputs,
                         const std::function<void(double)>& progress);

/// Removes a time range: writes the parts before and after it as separate records, by `axistool cut`, and returns their
/// names and the commands. Parts without enough rows are not written. Throws Failure(refused) if nothing remains.
nlohmann::json cut_out(const Folder& folder, const CutRequest& request);

/// Result of `axistool open` for logs: { "document": of its --json, "command" }. If no question is open, or uncertain
/// channels are accepted, the records are in their own folder.
nlohmann::json open_and_write(const Folder& folder, const OpenRequest& request);

}  // namespace host::workbench
