#include "host/workbench/commission_request.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/commission/folder.hpp"
#include "host/exit_codes.hpp"
#include "host/report/text_format.hpp"
#include "host/workbench/request_fields.hpp"

namespace host::workbench {

namespace {

std::string step_of(const nlohmann::json& document, const std::string& field) {
  std::string step = text_of(document, field);
  if (!step.empty()) commission_step(step);
  return step;
}

}  // namespace

CommissionRequest parse_commission(const nlohmann::json& document) {
  require_known(document, {"do", "owner", "model", "axis", "box", "overtravel_mm", "folder", "from", "to", "accept"});
  constexpr std::size_t kLongestBox = 120;
  CommissionRequest request;
  request.owner = text_of(document, "owner");
  request.axis = text_of(document, "axis");
  if (request.axis.size() != 1) refuse("axis", "expected an axis of the board");
  request.box = text_of(document, "box");
  if (request.box.empty() || request.box.size() > kLongestBox ||
      !std::ranges::all_of(request.box, [](char c) { return c > ' ' && c <= '~'; }))
    refuse("box", "expected travel=…mm,speed=…mm/s,volts=…V,time=…s");
  if (document.contains("overtravel_mm")) {
    request.overtravel_mm = number_of(document["overtravel_mm"], "overtravel_mm");
    if (!(*request.overtravel_mm >= 0.0)) refuse("overtravel_mm", "expected a length");
  }
  if (const std::string folder = text_of(document, "folder"); !folder.empty())
    request.folder = file_of(folder, "folder");
  request.from = step_of(document, "from");
  request.to = step_of(document, "to");
  if (!request.from.empty() && request.folder.empty()) refuse("from", "needs the folder");
  return request;
}

std::optional<double> CommissionRequest::overtravel() const {
  if (!overtravel_mm || !is_linear) return overtravel_mm;
  return *overtravel_mm / 1000.0;
}

void put(const CommissionRequest& request, nlohmann::json& document) {
  document["axis"] = request.axis;
  document["box"] = request.box;
  document["folder"] = request.folder;
  if (request.overtravel_mm) document["overtravel_mm"] = *request.overtravel_mm;
  if (!request.from.empty()) document["from"] = request.from;
  if (!request.to.empty()) document["to"] = request.to;
}

std::string command_line(const CommissionRequest& request, const std::string& sheet) {
  std::string line = fmt::format("axistool commission {} --drive {} --box {} -o {}", request.axis, shell_word(sheet),
                                 shell_word(request.box), shell_word(request.folder));
  if (const auto length = request.overtravel()) line += fmt::format(" --overtravel {:g}", *length);
  if (!request.from.empty()) line += " --from " + request.from;
  if (!request.to.empty()) line += " --to " + request.to;
  if (!request.device.empty()) line += " --device " + shell_word(request.device);
  return line;
}

std::string next_step(const std::string& folder) {
  try {
    const std::optional<std::size_t> next = CommissionFolder(folder).first_undone();
    return next ? std::string(kCommissionSteps[*next].name) : "";
  } catch (const Failure&) {  // the folder is gone or damaged
    return "";
  }
}

}  // namespace host::workbench
