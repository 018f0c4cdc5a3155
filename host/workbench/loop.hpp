// The page's design of a controller: the functions of `axistool design`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "host/response/loop_design.hpp"
#include "host/workbench/folder.hpp"

namespace host::workbench {

/// { "model": NAME, "response": ["model"] or [NAME...], "fc": Hz, "zeta": damping, "notch": [Hz, damping, depth] or
/// "auto", "low_pass": [Hz, damping], "margin": modulus margin, "write": whether to write the parameters }.
struct LoopRequest {
  std::string model;
  std::vector<std::string> response;
  DesignOptions options;
  LoopAim aim;
  bool writes = false;
};

/// Throws Failure(usage) naming the field and its expected value.
LoopRequest parse_loop(std::string_view text);

/// The equivalent command. `output`: file of the parameters; may be empty.
std::string loop_command(const LoopRequest& request, const std::string& output);

/// { "document": of --json, "report": HTML page, "parameters": TOML, "written": NAME or "", "command" }. Throws as the
/// command does.
nlohmann::json design_of(const Folder& folder, const LoopRequest& request);

}  // namespace host::workbench
