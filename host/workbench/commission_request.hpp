// A request to commission an axis of the board.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace host::workbench {

/// { "do": "commission", "owner": KEY, "model": DATA SHEET, "axis": "x", "box": "travel=80mm,…", "overtravel_mm": 5,
/// "folder": "x", "from": "diagnose", "to": "page" }. The data sheet is in Request::models. Without "folder" the run
/// starts in a new one; "from" needs it.
struct CommissionRequest {
  std::string owner;   ///< key of the page (PageOwnership); not stored
  std::string device;  ///< for the command; not stored
  std::string axis, box, folder, from, to;
  std::optional<double> overtravel_mm;
  bool is_linear = false;  ///< kind of the drive, for the command; not stored

  /// In the units of the drive, mm or m.
  std::optional<double> overtravel() const;
};

/// Throws Failure(usage) naming the field and its expected value.
CommissionRequest parse_commission(const nlohmann::json& document);

void put(const CommissionRequest& request, nlohmann::json& document);

/// The equivalent command, which asks before each motion.
std::string command_line(const CommissionRequest& request, const std::string& sheet);

/// First step that is not done; "" if all are done or the folder holds no commissioning.
std::string next_step(const std::string& folder);

}  // namespace host::workbench
