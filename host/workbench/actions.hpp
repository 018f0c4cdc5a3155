// The page's actions. They use the functions of the commands, so documents are identical.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/input_limits.hpp"
#include "host/share_done.hpp"
#include "host/workbench/folder.hpp"
#include "host/workbench/request.hpp"

namespace host {
struct ComparedModel;
}

namespace host::workbench {

/// Records of a comparison while the page waits, once for each model. A MiB takes 15 MB of memory and 0.3 s of a
/// processor.
inline constexpr ByteLimit kComparedSize{"a comparison in the workbench", 128 * kMebibyte, true};

struct Comparison {
  nlohmann::json document;  ///< JSON of `axistool compare --json`
  std::string report;       ///< HTML page; empty if no command, torque or force was recorded
  std::string text;         ///< text for the page if there is no report
  std::string traces;       ///< record whose traces the page draws
};

/// Compares the models of the request with its records. Throws as the command does.
std::vector<ComparedModel> compared_models(const Folder& folder, const Request& request);

/// While the page waits, of at most kComparedSize. Throws as the command does.
Comparison compare(const Folder& folder, const Request& request);

/// The same as a job, of any size. Throws as the command does, and Cancelled.
Comparison compare_all(const Folder& folder, const Request& request, const ShareDone& progress);

/// Effects whose part looks like the residual of the first model over the coordinate `like` (likeness_json). Throws as
/// the command does.
nlohmann::json look_alike(const Folder& folder, const Request& request);

/// Compares the model with one that has the values of an adjust request. Writes the latter only to kTrial. Throws as
/// the command does.
Comparison compare_trial(const Folder& folder, const Request& request);
inline constexpr const char* kTrial = "trial.toml";

/// Result of a quick diagnosis: "document" (the JSON of --json) and "report" (the page). If the records allow none, the
/// document is null, with a "reason". Throws as the command does.
nlohmann::json look_first(const Folder& folder, const Request& request);

/// The plot of an effect in the gallery, for report.js, and the size of its residual relative to a run without it.
/// Throws Failure(usage) for an unknown kind.
nlohmann::json gallery_picture(const std::string& kind);

/// Identifies, diagnoses, adds, adjusts or improves, writes the outputs, and returns the document of the command's
/// --json. Throws as the command does, and Cancelled.
nlohmann::json carry_out(const Folder& folder, const Request& request, const Outputs& outputs,
                         const ShareDone& progress);

/// Removes a time range: writes the parts before and after it as separate records, by `axistool cut`, and returns their
/// names and the commands. Parts without enough rows are not written. Throws Failure(refused) if nothing remains.
nlohmann::json cut_out(const Folder& folder, const CutRequest& request);

/// Result of `axistool open` for logs: { "document": JSON of its --json, "command" }. If no question is open, or
/// uncertain channels are accepted, also writes the records to a separate folder.
nlohmann::json open_and_write(const Folder& folder, const OpenRequest& request);

}  // namespace host::workbench
